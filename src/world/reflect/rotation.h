// rotation.h - the rotation nearest to a matrix, and the least one between two directions
#ifndef REFLECT_ROTATION_H
#define REFLECT_ROTATION_H

#include "core/math/vec.h"

struct rotation {
    vec3 row[3];
};

static inline vec3 rotate(const struct rotation *r, vec3 v)
{
    return vec3_of(vec3_dot(r->row[0], v), vec3_dot(r->row[1], v), vec3_dot(r->row[2], v));
}

// m += w a b^T
static inline void add_outer(struct rotation *m, double w, vec3 a, vec3 b)
{
    m->row[0] = vec3_along(m->row[0], b, w * a.x);
    m->row[1] = vec3_along(m->row[1], b, w * a.y);
    m->row[2] = vec3_along(m->row[2], b, w * a.z);
}

// By the least angle from one unit vector to another; of opposite ones about some axis.
struct rotation rotation_least(vec3 from, vec3 to);

// The rotation R (determinant +1) of greatest trace(R^T m), the rotational factor of m (orthogonal
// Procrustes: Schoenemann 1966, Kabsch 1976). Where m leaves a turn open, since its rank is one or
// zero, it is the least.
struct rotation rotation_nearest(const struct rotation *m);

#endif
