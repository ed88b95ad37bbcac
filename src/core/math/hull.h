// hull.h - triangulation of directions on the sphere: the convex hull of unit vectors is their
// spherical Delaunay triangulation (Brown 1979)
#ifndef MATH_HULL_H
#define MATH_HULL_H

#include <relume/base.h>

struct hull_triangle {
    int corner[3];  // counter-clockwise seen from outside
};

// The hull of `n` >= 4 unit vectors that do not all lie in one plane. The caller frees
// `*triangles`. Points equal to an earlier one are left out. RELUME_EUNFIT when the points are
// coplanar, RELUME_ENOMEM.
relume_status hull_build(const struct relume_vec3 *points, int n, struct hull_triangle **triangles,
                         int *count);

// Where the ray along `d` crosses a triangle's plane: weights of the corners (they sum to 1). The
// triangle is hit when all are >= 0. False when it faces away from `d`.
bool hull_weights(const struct relume_vec3 *points, struct hull_triangle triangle,
                  struct relume_vec3 d, double weights[3]);

#endif
