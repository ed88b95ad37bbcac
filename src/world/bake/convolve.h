// convolve.h - materials under light from all sides at once (Meseth 2008, 10.1.1)
//
// What arrives at a place becomes spherical harmonics of degree 5 in the axes of the material, and
// so does what each of its texels shows of light from there, for every view: once for all places
// that show the texel. A place then shows a sum of 36 products.
#ifndef BAKE_CONVOLVE_H
#define BAKE_CONVOLVE_H

#include "world/object/object.h"

enum { CONVOLVE_DEGREE = 5, CONVOLVE_COUNT = (CONVOLVE_DEGREE + 1) * (CONVOLVE_DEGREE + 1) };

struct convolved {
    int width, height, views;  // texels of the material, views of the map
    float *value;              // [texels][views][CONVOLVE_COUNT][3]
};

// Of a material from the views of a map of `side`. `*out` is NULL where that would take more memory
// than `most` bytes. RELUME_ENOMEM.
relume_status convolved_create(struct convolved **out, const relume_btf_surface *surface, int width,
                               int height, int side, uint64_t most, int threads);
void convolved_destroy(struct convolved **c);

// Light from a unit direction in the axes of the material is added to light[CONVOLVE_COUNT][3].
void convolved_add(float light[][3], vec3 direction, const float rgb[3]);
// What the texel at (s, t) of repeats shows of it is added: out[views][3]. `mirrored`: the map's
// second axis is turned round.
void convolved_show(float *out, const struct convolved *c, double s, double t, bool mirrored,
                    float light[][3]);

#endif
