// stage.h - what one view sees, as something that rays towards lights meet
#ifndef SHADOW_STAGE_H
#define SHADOW_STAGE_H

#include "core/math/vec.h"

#include <relume/capture.h>
#include <relume/image.h>

// As relume_shadows_rays.
enum stage_kind { STAGE_FLAT, STAGE_EYE, STAGE_CYLINDER, STAGE_SPHERE };

// How far four neighbours are, at least and at most.
struct cell {
    float least, most;
};

// Coordinates are those of the view: its eye, or for parallel rays the middle of its plane, is the
// origin, the axis -z (planar, slabs), the pole y (panoramas).
struct stage {
    enum stage_kind kind;
    struct relume_pose pose;    // directions of the view in the world
    vec3 eye;                   // the origin of the view, in the world
    double scale[2], shift[2];  // pixel = scale x + shift, x per unit of distance, angle or world
    double axis;                // z of rays: -1, or 1 where the eye is behind its window
    double pixel;               // side of a pixel at distance 1, or of STAGE_FLAT everywhere
    double least_side;          // rays take pixels for no smaller: there is no surface so near
    int width, height;
    float *far;    // [height][width]: how far the surface is along the axis, from the pole's axis
                   // (cylinder) or from the eye (sphere); infinite: background
    float *thick;  // [height][width]: behind it, where light is stopped
    float *front;  // [rows of tiles][columns]: what is nearest in a tile or beside it
    struct cell *cell;  // [height + 1][width + 1]: of the pixels on both sides of each corner
    vec3 low, high;     // a box around the surface
};

bool stage_suits(const struct relume_geometry *g);
// Things are as thick as the box is large. RELUME_ENOMEM; end with stage_destroy in any case.
relume_status stage_create(struct stage *s, const struct relume_geometry *g, const double uv[2],
                           const struct relume_image *depth);
void stage_destroy(struct stage *s);

// A direction of the world in the view's coordinates.
static inline vec3 stage_turn(const struct stage *s, vec3 world)
{
    return relume_pose_turn_back(&s->pose, world);
}

// A point of the view in the world.
static inline vec3 stage_world(const struct stage *s, vec3 point)
{
    return vec3_add(s->eye, relume_pose_turn(&s->pose, point));
}

// The surface at (x, y) in pixels; false for background.
bool stage_point(vec3 *point, const struct stage *s, double x, double y);
// Whether light from a unit direction (of the view), and so far away, reaches a point of the
// surface.
bool stage_reaches(const struct stage *s, vec3 point, vec3 direction, double distance);

// Light does reach it: the surfaces that its ray passes behind are no thicker than that. The
// STAGE_LEAST smallest distances behind each pixel are kept, in `least`, rising. True where the ray
// passes behind nothing: stage_reaches is then true however thick things are.
enum { STAGE_LEAST = 8 };
// A value among them.
void stage_keep_least(float least[STAGE_LEAST], float value);
bool stage_carve(float (*least)[STAGE_LEAST], const struct stage *s, vec3 point, vec3 direction);

#endif
