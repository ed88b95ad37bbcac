// plane.h - planes through triangles, by sums that add up
#ifndef DISTANCE_PLANE_H
#define DISTANCE_PLANE_H

#include "core/math/vec.h"

#include <relume/shape/mesh.h>

// Triangles with an extent, about the middle of their box.
struct soup {
    vec3 (*corner)[3];  // [count]
    vec3 *normal;       // unit
    double *area;
    uint32_t *number;  // in the mesh
    size_t count;
    vec3 middle;
    double longest;  // side of the box
};
// RELUME_EINVAL, RELUME_EUNFIT, RELUME_ENOMEM.
relume_status soup_create(struct soup *out, const struct relume_mesh *mesh,
                          const struct relume_log *log);
void soup_free(struct soup *s);

// Integrals over triangles: what their plane of least squares is made of.
struct moments {
    double area, square[6];  // xx, xy, xz, yy, yz, zz
    vec3 first, normal;      // of places; of normals, each of the length of its area
};
struct moments moments_of(const struct soup *s, size_t triangle);
struct moments moments_sum(const struct moments *a, const struct moments *b);

// dot(normal, place) = offset; the axes lie in the plane, the longer extent along x.
struct plane {
    vec3 x, y, normal;
    double offset;
};
// Of least squares, its normal on the triangles' side.
struct plane moments_plane(const struct moments *m);
// The plane of a normal; any axes.
struct plane plane_of(vec3 normal, double offset);

struct range {
    double low, high;
};
static const struct range range_none = {INFINITY, -INFINITY};
static inline void range_add(struct range *r, double v)
{
    r->low = v < r->low ? v : r->low;  // one instruction each, where fmin is a call
    r->high = v > r->high ? v : r->high;
}

// How triangles lie to a plane.
struct fit {
    struct range height;  // of vertices along the normal
    double least_cosine;  // between normals
};
static inline struct fit fit_none(void)
{
    return (struct fit){range_none, 1.0};
}
void fit_add(struct fit *f, const struct soup *s, size_t triangle, vec3 normal);

#endif
