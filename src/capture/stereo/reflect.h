// reflect.h - what a surface sends to the eye under lights from many sides, in parts
//
// A reflectance is a sum with positive weights of four kinds of matte and eight widths of gloss:
// Lambert's cosine c; c / (c + cosine to the eye) (Lommel and Seeliger: flatter); c^2 (steeper);
// the roughness of Oren and Nayar 1994; Beckmann lobes. Lobes whose
// widths follow each other add up to those with long tails (GGX is such a sum).
#ifndef STEREO_REFLECT_H
#define STEREO_REFLECT_H

#include "core/math/vec.h"

enum { REFLECT_MATTE = 4, REFLECT_LOBES = 8, REFLECT_PARTS = REFLECT_MATTE + REFLECT_LOBES };

// Lights and the eye as one pixel sees them, prepared for sums over lights.
struct reflect_lights {
    int n, stride;  // floats from row to row of `at`
    vec3 eye;       // unit, towards it
    float *at;      // [7][stride]: x, y, z of lights; x, y, z of halves between eye and light; the
                    // cosine between them
};

int reflect_stride(int lights);
size_t reflect_floats(int lights);
void reflect_lights_set(struct reflect_lights *to, const vec3 *direction, vec3 eye);

// parts[REFLECT_PARTS][stride], times the cosine to the light; only those whose bit is set in
// `which`. `scratch` has 2 x stride floats.
void reflect_parts(float *parts, unsigned which, const struct reflect_lights *lights, vec3 normal,
                   float *scratch);

#endif
