// vec.h - what the viewer needs of vector arithmetic; the library's is private to it
#ifndef VIEWER_VEC_H
#define VIEWER_VEC_H

#include <relume/base.h>

#include <math.h>

static inline double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

static inline double vec_dot(struct relume_vec3 a, struct relume_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct relume_vec3 vec_cross(struct relume_vec3 a, struct relume_vec3 b)
{
    return (struct relume_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                                a.x * b.y - a.y * b.x};
}

static inline struct relume_vec3 vec_sub(struct relume_vec3 a, struct relume_vec3 b)
{
    return (struct relume_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct relume_vec3 vec_scale(struct relume_vec3 a, double s)
{
    return (struct relume_vec3){s * a.x, s * a.y, s * a.z};
}

static inline double vec_length(struct relume_vec3 a)
{
    return sqrt(vec_dot(a, a));
}

static inline struct relume_vec3 vec_unit(struct relume_vec3 a)
{
    return vec_scale(a, 1.0 / vec_length(a));
}

#endif
