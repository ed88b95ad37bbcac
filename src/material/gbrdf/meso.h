// meso.h - the relief of a g-BRDF: heights over the plane of the sample, and the rays that meet
// them
//
// Places are in texels: x to the right, y down the rows, texel centres at +0.5, z off the plane.
// Between texels the height is bilinear, and the sample is repeated without end. Directions are
// those of BTFs, whose y points up: against the rows.
#ifndef GBRDF_MESO_H
#define GBRDF_MESO_H

#include "core/math/bilinear.h"
#include "core/math/vec.h"

struct meso {
    int width, height;
    const float *z;   // [height][width]
    float low, high;  // the least and the greatest of them
};

// Find low and high.
void meso_settle(struct meso *m);

double meso_height(const struct meso *m, double x, double y);

// Where a ray from the eye in direction `v` through (x, y) of the plane meets the relief first.
vec3 meso_seen(const struct meso *m, double x, double y, vec3 v);

// Whether the way from a place on the relief towards `d` is free.
bool meso_open(const struct meso *m, vec3 from, vec3 d);

// The normal of a texel, by Sobel's filter.
vec3 meso_normal(const struct meso *m, int x, int y);

#endif
