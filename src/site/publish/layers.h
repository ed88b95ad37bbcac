// layers.h - what views have beside their planes: depth and masks
#ifndef PUBLISH_LAYERS_H
#define PUBLISH_LAYERS_H

#include "site/publish/site.h"

#include <relume/pack.h>

// Of a view. Depth is v = 256 red + green: 0 for the background, else
// 1 / depth = depth_min + (v - 1) depth_step.
struct layers {
    bool depth, mask;
    double depth_min, depth_step;
};

// The range of a depth, and what a value of it becomes: v.
void layers_find_steps(struct layers *l, const struct relume_image *depth);
int layers_code(const struct layers *l, float depth);

// Write depth.png and mask.png of a view, where the file has them, into the folder `name` of the
// site. Errors of reading, RELUME_EIO, RELUME_ENOMEM.
relume_status layers_write(struct layers *out, const struct site *site, const char *name,
                           relume_pack *pack, int view);

#endif
