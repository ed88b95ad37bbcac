// frame.h - where a part of a scene stands: an affine map from its own coordinates to the world
#ifndef GEOMETRY_FRAME_H
#define GEOMETRY_FRAME_H

#include "core/math/vec.h"

struct frame {
    vec3 x, y, z;  // images of the axes
    vec3 origin;
};

static const struct frame frame_world = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};

static inline vec3 frame_vector(const struct frame *f, vec3 v)
{
    return vec3_along(vec3_along(vec3_scale(f->x, v.x), f->y, v.y), f->z, v.z);
}

static inline vec3 frame_point(const struct frame *f, vec3 p)
{
    return vec3_add(frame_vector(f, p), f->origin);
}

// Normals go with the cofactors, so that uneven scaling keeps them upright and mirroring turns
// them.
static inline vec3 frame_normal(const struct frame *f, vec3 n)
{
    const vec3 v =
        vec3_along(vec3_along(vec3_scale(vec3_cross(f->y, f->z), n.x), vec3_cross(f->z, f->x), n.y),
                   vec3_cross(f->x, f->y), n.z);
    return vec3_length(v) > 0.0 ? vec3_unit(v) : n;
}

// The unit direction of a vector of the world, in a frame that turns and scales evenly.
static inline vec3 frame_turned_back(const struct frame *f, vec3 v)
{
    return vec3_unit(vec3_of(vec3_dot(v, f->x), vec3_dot(v, f->y), vec3_dot(v, f->z)));
}

// First `inner`, then `outer`.
static inline struct frame frame_compose(struct frame outer, struct frame inner)
{
    return (struct frame){
        .x = frame_vector(&outer, inner.x),
        .y = frame_vector(&outer, inner.y),
        .z = frame_vector(&outer, inner.z),
        .origin = frame_point(&outer, inner.origin),
    };
}

static inline struct frame frame_move(double x, double y, double z)
{
    return (struct frame){{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {x, y, z}};
}

static inline struct frame frame_scale(double x, double y, double z)
{
    return (struct frame){{x, 0, 0}, {0, y, 0}, {0, 0, z}, {0, 0, 0}};
}

// Right-handed turns about an axis, in radians.
static inline struct frame frame_turn_x(double angle_rad)
{
    const double c = cos(angle_rad), s = sin(angle_rad);
    return (struct frame){{1, 0, 0}, {0, c, s}, {0, -s, c}, {0, 0, 0}};
}

static inline struct frame frame_turn_y(double angle_rad)
{
    const double c = cos(angle_rad), s = sin(angle_rad);
    return (struct frame){{c, 0, -s}, {0, 1, 0}, {s, 0, c}, {0, 0, 0}};
}

static inline struct frame frame_turn_z(double angle_rad)
{
    const double c = cos(angle_rad), s = sin(angle_rad);
    return (struct frame){{c, s, 0}, {-s, c, 0}, {0, 0, 1}, {0, 0, 0}};
}

#endif
