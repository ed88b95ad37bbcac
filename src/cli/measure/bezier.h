// bezier.h - where a curved mirror of four by four control points reflects a place to an eye
#ifndef MEASURE_BEZIER_H
#define MEASURE_BEZIER_H

#include "core/math/vec.h"

// In powers of u and v, from what bezier_make is given.
struct bezier {
    vec3 power[4][4];
};
struct bezier_point {
    vec3 s, u, v, uu, uv, vv;  // the place and its derivatives
};

// Of control points, the first index along u.
void bezier_make(struct bezier *out, const vec3 control[4][4]);
void bezier_at(struct bezier_point *out, const struct bezier *b, double u, double v);

struct bezier_reflection {
    double u, v;     // beyond [0, 1] where the patch ends before it gets there
    vec3 place;      // on the mirror
    double length;   // of the way from the eye to the place by the mirror
    int iterations;  // it took
};
// False where it does not come to rest: the patch is not convex there.
bool bezier_reflect(struct bezier_reflection *out, const struct bezier *b, vec3 eye, vec3 place);

#endif
