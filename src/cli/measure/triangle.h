// triangle.h - where a triangle with normals at its corners reflects a place to an eye
#ifndef MEASURE_TRIANGLE_H
#define MEASURE_TRIANGLE_H

#include "core/math/vec.h"

// Corners, and the directions in which each sends what the eye sends there.
struct mirror_triangle {
    vec3 t[3], d[3];
};
// Normals are unit, on the side of the eye.
void mirror_triangle_make(struct mirror_triangle *out, const vec3 corner[3], const vec3 normal[3],
                          vec3 eye);

struct triangle_reflection {
    double a, b;  // weights of the second and third corner; of the first 1 - a - b
    double k;     // how far the place lies along the direction there
};
// The nearest to the middle of the triangle; false where there is none before it.
bool mirror_triangle_reflect(struct triangle_reflection *out, const struct mirror_triangle *m,
                             vec3 place);

#endif
