// ramp.h - the distance of near lights, by how brightness changes across a flat matte surface
#ifndef ACQUIRE_RAMP_H
#define ACQUIRE_RAMP_H

#include "core/math/vec.h"

#include <relume/capture/ball.h>
#include <relume/image.h>

// Small photographs of one view, linear, each under one lamp.
struct ramp_search {
    const struct relume_image *const *small;  // [count], three channels, of one size
    const vec3 *direction;                    // [count], unit, of the lamps from ...
    vec3 origin;                              // ... here, world units
    int count;
    double step;                     // a small pixel in pixels of the photographs
    const struct relume_ball *ball;  // [balls] that stand in the photographs
    int balls;
};

// Finds the distance of all lamps from 0, 0, 0, world units; 0 where brightness does not show it:
// lamps are distant, or the surface is curved, glossy or rough. RELUME_ENOMEM.
relume_status ramp_find(double *distance, const struct ramp_search *search);

// Returns where a lamp at that distance from 0, 0, 0 stands, seen from `origin`.
vec3 ramp_place(vec3 origin, vec3 direction, double distance);

#endif
