// vec.h - arithmetic of directions and places, inline
//
// Defining RELUME_VEC3_SHORT before this is included gives short names too: vec3, vec3_add, ...
#ifndef RELUME_VEC_H
#define RELUME_VEC_H

#include <relume/base.h>

#include <math.h>

#ifdef __cplusplus
extern "C" {
#endif

// The vector (x, y, z).
static inline struct relume_vec3 relume_vec3_of(double x, double y, double z)
{
    struct relume_vec3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}

// a + b.
static inline struct relume_vec3 relume_vec3_add(struct relume_vec3 a, struct relume_vec3 b)
{
    return relume_vec3_of(a.x + b.x, a.y + b.y, a.z + b.z);
}

// a - b.
static inline struct relume_vec3 relume_vec3_sub(struct relume_vec3 a, struct relume_vec3 b)
{
    return relume_vec3_of(a.x - b.x, a.y - b.y, a.z - b.z);
}

// a times the number s.
static inline struct relume_vec3 relume_vec3_scale(struct relume_vec3 a, double s)
{
    return relume_vec3_of(a.x * s, a.y * s, a.z * s);
}

// a + t b: the place that a ray from a along b reaches at t.
static inline struct relume_vec3 relume_vec3_along(struct relume_vec3 a, struct relume_vec3 b,
                                                   double t)
{
    return relume_vec3_of(a.x + t * b.x, a.y + t * b.y, a.z + t * b.z);
}

// The scalar product.
static inline double relume_vec3_dot(struct relume_vec3 a, struct relume_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// The vector product, right-handed.
static inline struct relume_vec3 relume_vec3_cross(struct relume_vec3 a, struct relume_vec3 b)
{
    return relume_vec3_of(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

// The length, in the unit of a.
static inline double relume_vec3_length(struct relume_vec3 a)
{
    return sqrt(relume_vec3_dot(a, a));
}

// The unit vector along a, which is not zero.
static inline struct relume_vec3 relume_vec3_unit(struct relume_vec3 a)
{
    return relume_vec3_scale(a, 1.0 / relume_vec3_length(a));
}

// The angle between unit vectors in radians, exact near 0 and pi.
static inline double relume_vec3_angle(struct relume_vec3 a, struct relume_vec3 b)
{
    return 2.0 * atan2(relume_vec3_length(relume_vec3_sub(a, b)),
                       relume_vec3_length(relume_vec3_add(a, b)));
}

#ifdef __cplusplus
}
#endif
#endif

#if defined RELUME_VEC3_SHORT && !defined vec3_of
typedef struct relume_vec3 vec3;  // the short names
#define vec3_of     relume_vec3_of
#define vec3_add    relume_vec3_add
#define vec3_sub    relume_vec3_sub
#define vec3_scale  relume_vec3_scale
#define vec3_along  relume_vec3_along
#define vec3_dot    relume_vec3_dot
#define vec3_cross  relume_vec3_cross
#define vec3_length relume_vec3_length
#define vec3_unit   relume_vec3_unit
#define vec3_angle  relume_vec3_angle
#endif
