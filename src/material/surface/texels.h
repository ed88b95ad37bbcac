// texels.h - single texels of a surface with a measured material
#ifndef SURFACE_TEXELS_H
#define SURFACE_TEXELS_H

#include "material/model/environment.h"

#include <relume/material/surface.h>

// The model and the map of a level of detail, for clients that look texels up themselves.
struct relume_btf_surface_level {
    const relume_btf_fitted *model;         // of the level
    const struct relume_btf_map_info *map;  // of the level
};
// Level 0 is the finest. What it points to belongs to the surface.
struct relume_btf_surface_level relume_btf_surface_level(const relume_btf_surface *surface,
                                                         int level);

// From where a point is looked at and lit: unit vectors in the frame of the surface.
struct relume_btf_ray {
    struct relume_vec3 view, light;  // towards the eye, towards the light
    // An environment in place of the light, or NULL: in the one orientation of an ambient, or in
    // that of `frame`.
    const relume_btf_oriented_light *ambient;
    const relume_btf_environment *sky;  // an environment in place of `light`, or NULL
    struct relume_btf_frame frame;      // with `sky`: of the surface in the world
};

// The value at (x, y) texels, as relume_btf_evaluate: the four texels around the point are fetched
// through the map, evaluated, then interpolated, and so on the two levels of detail around `level`
// (0: the texels themselves; a level has half the texels of the one before).
void relume_btf_surface_evaluate(const relume_btf_surface *surface, double x, double y,
                                 double level, const struct relume_btf_ray *ray, float rgb[3]);

// Where a pixel sees the surface: its centre, and the way to the centres of the pixels to the
// right and below, texels.
struct relume_btf_footprint {
    double x, y;               // the centre
    double right[2], down[2];  // to the next pixels
};
// The mean over a pixel: at most 8 lookups along the longer way, on the level that the rest asks
// for.
void relume_btf_surface_filter(const relume_btf_surface *surface,
                               const struct relume_btf_footprint *footprint,
                               const struct relume_btf_ray *ray, float rgb[3]);

#endif
