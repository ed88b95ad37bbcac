// zone.h - making the zone that a capture's lights cover (struct relume_captured_region)
#ifndef CODER_ZONE_H
#define CODER_ZONE_H

#include "format/coder/coding.h"

#include <relume/format/coder.h>

struct zone_params {
    bool hemispherical, pole_y;
    double part;  // of the way to its nearest neighbour that a light speaks for
};
// Of `n` unit directions of the world.
void zone_find(struct relume_captured_region *zone, const struct relume_vec3 *lights, int n,
               const struct zone_params *params);

#endif
