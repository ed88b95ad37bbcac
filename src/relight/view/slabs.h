// slab_set.h - the inside of relume_slab_set
#ifndef VIEW_SLABS_H
#define VIEW_SLABS_H

#include "core/math/vec.h"
#include "image/geometry/geometry.h"
#include "relight/view/slab.h"
#include "relight/view/view.h"

#include <relume/relight/slab_set.h>

struct relume_slab_set {
    int count, views;
    relume_slab *slab[RELUME_MOST_SLABS];
};

// The ray from `eye` along `direction` in a slab's own frame: where it crosses the two planes.
// False when it leaves the side on which the cameras stand without crossing the st plane.
bool slabs_ray(double uv[2], double st[2], const relume_slab *slab, vec3 eye, vec3 direction);

#endif
