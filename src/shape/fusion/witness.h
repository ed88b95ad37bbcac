// witness.h - a view with depth: how far a place lies before or behind what it sees
#ifndef FUSION_WITNESS_H
#define FUSION_WITNESS_H

#include "image/geometry/project.h"

#include <relume/image.h>

struct witness {
    struct camera camera;
    struct relume_image depth;  // along the rays; infinite: nothing is there, NaN: nobody knows
    float *cosine;              // [height][width] of the ray and the surface; 0: not known
};

// Takes over `depth`, whatever is returned. What is beyond `farthest` is nothing, what is not above
// 0 is not known. RELUME_ENOMEM.
relume_status witness_create(struct witness *out, const struct camera *camera,
                             struct relume_image *depth, double farthest, int threads);
void witness_destroy(struct witness *s);

// The place that the middle of a pixel sees; false where that is nothing.
bool witness_place(vec3 *place, const struct witness *s, int x, int y);

// What a view says of a place.
struct sighting {
    double xy[2];     // the pixel position
    double distance;  // of the surface before the place, along the normal: positive behind it;
                      // -infinite where nothing is
    double along;     // the same along the ray
    double cosine;    // of the ray and the surface
};
// False where it says nothing: beside the picture, or where it does not know. `step`: depth differs
// by more than that where one surface ends and another begins.
bool witness_ask(struct sighting *out, const struct witness *s, vec3 place, double step);

// What a relit view of the witness's size shows at a pixel position within it: the mean of the four
// pixels around, without those whose depth differs by more than `step` from that of the pixel.
void witness_light(float rgb[3], const struct witness *s, const struct relume_image *relit,
                   const double xy[2], double step);

#endif
