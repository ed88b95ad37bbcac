// rays.h - rays from balls towards a lamp: whether it is near, and where it stands
#ifndef ACQUIRE_RAYS_H
#define ACQUIRE_RAYS_H

#include "core/math/vec.h"

#include <stdbool.h>

enum { MOST_BALLS = 16 };

// Rays of the balls that show the lamp of one photograph, in world units.
struct ball_rays {
    int n;
    vec3 origin[MOST_BALLS], direction[MOST_BALLS];  // unit directions
};

// Standard deviations of a ray's angle, radians along one axis.
struct rays_fit {
    double distant;   // if the rays of each photograph are parallel
    double near;      // if they meet at a lamp
    double distance;  // geometric mean of the lamps' distances from the balls' middle, or 0
};

// Fits both models to photographs with two rays or more.
struct rays_fit rays_compare(const struct ball_rays *rays, int photographs);
// Returns true where the lamps are so near that directions alone would be wrong.
bool rays_show_near(const struct rays_fit *fit);

// Computes position[photographs] and its standard error, where rays err by `error` radians along
// one axis. Uncertain distances shrink to the mean. Returns false unless two rays meet.
bool rays_place(vec3 *position, double *sigma, const struct ball_rays *rays, int photographs,
                double error);

#endif
