// level.h - what two captures differ in all over the picture, taken away
#ifndef CHANGE_LEVEL_H
#define CHANGE_LEVEL_H

#include "material/change/place.h"

enum { LEVEL_TERMS = 6 };  // of a quadratic polynomial of the place

// Normals of the first are `turn` times those of the second, made unit, plus a bend; colours are
// the second's (cube roots) times a gain. Both are polynomials of x and y in [-1, 1].
struct level {
    double turn[3][3];
    double bend[2][LEVEL_TERMS];  // of x and y
    double gain[3][LEVEL_TERMS];  // of the logarithms of red, green and blue cube roots
    double bend_deg;              // the largest in the picture
};

// `b` is sampled at the places of `a`. Found robustly, so that what has changed does not count
// where it is the smaller part. RELUME_ENOMEM.
relume_status level_find(struct level *out, const struct surface *a, const struct surface *b,
                         const struct place *place, bool keep_bend, int threads);
// Makes `b`, and its noise, as `a` would be.
void level_apply(const struct level *level, struct surface *b, int threads);

#endif
