// plane_sweep.h - how well the cameras of a slab agree that a pixel lies on a plane
//
// Plane sweep (Collins 1996) over disparities (view.h: a point of disparity q that the camera at c
// sees in x is seen by the camera at c' in x + q (c - c')), so that every plane is a mere shift.
// Occlusions: what one side of an occluder sees the other cannot, so the least cost among the
// cameras to the left, right, above and below counts (Kang, Szeliski, Chai 2001).
#ifndef MULTIVIEW_PLANE_SWEEP_H
#define MULTIVIEW_PLANE_SWEEP_H

#include <relume/base.h>

enum {
    PLANE_SWEEP_SIDES = 4,
    PLANE_SWEEP_NEIGHBOURS = 24,
    PLANE_SWEEP_SCALE = 4,
    PLANE_SWEEP_MOST = 63
};

// Pictures of one size, display values; all lights' colours are channels.
struct plane_sweep {
    int width, height, channels, views;
    uint8_t *const *picture;  // [views], [channel][height][width]
    const double (*at)[2];    // where cameras stand, in texels per unit of disparity: right, down
};

// A camera and those that it is compared with.
struct plane_sweep_target {
    int view, count;
    int other[PLANE_SWEEP_NEIGHBOURS];
    unsigned sides[PLANE_SWEEP_NEIGHBOURS];  // bit k: stands on side k
    bool used[PLANE_SWEEP_SIDES];            // enough cameras stand there
};

// The up to `most` nearest cameras around `view`.
struct plane_sweep_target plane_sweep_target(const struct plane_sweep *sweep, int view, int most);
// How far the farthest of them stands, texels per unit of disparity.
double plane_sweep_reach(const struct plane_sweep *sweep, const struct plane_sweep_target *target);

// Memory for the sums of one row.
struct plane_sweep_scratch {
    uint16_t *one, *sum, *count;  // [width], [PLANE_SWEEP_SIDES + 1][width] twice
};
relume_status plane_sweep_scratch_create(struct plane_sweep_scratch *out, int width);
void plane_sweep_scratch_free(struct plane_sweep_scratch *scratch);

// Costs of one row for one disparity, PLANE_SWEEP_SCALE x the mean truncated difference of the
// channels: the least over the sides, and (or NULL) the mean over all cameras.
void plane_sweep_row(uint8_t *least, uint8_t *mean, const struct plane_sweep *sweep,
                     const struct plane_sweep_target *target, double disparity, int row,
                     const struct plane_sweep_scratch *scratch);

#endif
