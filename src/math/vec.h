// vec.h - vectors, and the ONE statement of axes and signs
//
// World: right-handed, x right, y up, z towards the viewer. A light direction points towards the
// light. The pole of planar captures and of a slab is +z, of panoramas and of
// several slabs +y (Wong 1998 leaves it open):
//     +z: theta from +z, phi = atan2(y, x)       +y: theta from +y, phi = atan2(x, -z)
// In the pole's frame the third axis is the pole and phi = atan2(second, first).
#ifndef MATH_VEC_H
#define MATH_VEC_H

#include <relume/base.h>
#include <math.h>

typedef struct relume_vec3 vec3;

static inline vec3 vec3_of(double x, double y, double z)
{
    return (vec3){x, y, z};
}

static inline vec3 vec3_add(vec3 a, vec3 b)
{
    return vec3_of(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline vec3 vec3_sub(vec3 a, vec3 b)
{
    return vec3_of(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline vec3 vec3_scale(vec3 a, double s)
{
    return vec3_of(a.x * s, a.y * s, a.z * s);
}

static inline double vec3_dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vec3 vec3_cross(vec3 a, vec3 b)
{
    return vec3_of(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline double vec3_length(vec3 a)
{
    return sqrt(vec3_dot(a, a));
}

static inline vec3 vec3_unit(vec3 a)
{
    return vec3_scale(a, 1.0 / vec3_length(a));
}

// The angle between unit vectors, exact near 0 and pi.
static inline double vec3_angle(vec3 a, vec3 b)
{
    return 2.0 * atan2(vec3_length(vec3_sub(a, b)), vec3_length(vec3_add(a, b)));
}

// `a`, turned by the shortest way that brings the unit vector `n` to +z; n.z > -1.
static inline vec3 vec3_upright(vec3 a, vec3 n)
{
    const vec3 half = vec3_of(n.x, n.y, n.z + 1.0);
    const vec3 b = vec3_sub(a, vec3_scale(half, vec3_dot(a, half) / (1.0 + n.z)));
    return vec3_of(b.x, b.y, b.z + 2.0 * vec3_dot(n, a));
}

// World -> the frame whose third axis is the pole, and back.
static inline vec3 pole_from_world(vec3 w, bool pole_y)
{
    return pole_y ? vec3_of(-w.z, w.x, w.y) : w;
}

static inline vec3 world_from_pole(vec3 p, bool pole_y)
{
    return pole_y ? vec3_of(p.y, p.z, -p.x) : p;
}

#endif
