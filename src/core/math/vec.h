// vec.h - vectors, and the ONE statement of axes and signs
//
// World: right-handed, x right, y up, z towards the viewer. A light direction points towards the
// light. The pole of planar captures and of a slab is +z, of panoramas and of
// several slabs +y (Wong 1998 leaves it open):
//     +z: theta from +z, phi = atan2(y, x)       +y: theta from +y, phi = atan2(x, -z)
// In the pole's frame the third axis is the pole and phi = atan2(second, first).
#ifndef MATH_VEC_H
#define MATH_VEC_H

#define RELUME_VEC3_SHORT
#include <relume/core/vec.h>

static inline bool vec3_is_zero(vec3 a)
{
    return a.x == 0.0 && a.y == 0.0 && a.z == 0.0;
}

// Of three floats, and back.
static inline vec3 vec3_floats(const float v[3])
{
    return vec3_of((double)v[0], (double)v[1], (double)v[2]);
}

static inline void vec3_store(float out[3], vec3 v)
{
    out[0] = (float)v.x, out[1] = (float)v.y, out[2] = (float)v.z;
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
