// repair.h - pixels that hold NaN or infinity
#ifndef CAPTURE_REPAIR_H
#define CAPTURE_REPAIR_H

#include "core/math/vec.h"

// How many of `n` pixels of three channels are not finite.
size_t repair_count(const float *pixels, size_t n);

// Replaces them in a band of images out[light][n][3]: by the same place under the three nearest
// lights where it is whole, weighted by 1 / angle; by black where there is none. broken[lights]
// says which images to look at; `whole` holds a word about each.
void repair_band(float *out, const size_t *broken, const vec3 *directions, int lights, size_t n,
                 bool *whole);

#endif
