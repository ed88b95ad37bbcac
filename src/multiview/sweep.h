// sweep.h - how well the cameras of a slab agree that a pixel lies on a plane
//
// Plane sweep (Collins 1996) over disparities (view.h: a point of disparity q that the camera at c
// sees in x is seen by the camera at c' in x + q (c - c')), so that every plane is a mere shift.
// Occlusions: what one side of an occluder sees the other cannot, so the least cost among the
// cameras to the left, right, above and below counts (Kang, Szeliski, Chai 2001).
#ifndef MULTIVIEW_SWEEP_H
#define MULTIVIEW_SWEEP_H

#include <relume/base.h>

enum { SWEEP_SIDES = 4, SWEEP_NEIGHBOURS = 24, SWEEP_SCALE = 4, SWEEP_MOST = 63 };

// Pictures of one size, display values; all lights' colours are channels.
struct sweep {
    int width, height, channels, views;
    uint8_t *const *picture;  // [views], [channel][height][width]
    const double (*at)[2];    // where cameras stand, in texels per unit of disparity: right, down
};

// A camera and those that it is compared with.
struct sweep_target {
    int view, count;
    int other[SWEEP_NEIGHBOURS];
    unsigned sides[SWEEP_NEIGHBOURS];  // bit k: stands on side k
    bool used[SWEEP_SIDES];            // enough cameras stand there
};

// The up to `most` nearest cameras around `view`.
struct sweep_target sweep_target(const struct sweep *sweep, int view, int most);
// How far the farthest of them stands, texels per unit of disparity.
double sweep_reach(const struct sweep *sweep, const struct sweep_target *target);

// Room for the sums of one row.
struct sweep_scratch {
    uint16_t *one, *sum, *count;  // [width], [SWEEP_SIDES + 1][width] twice
};
relume_status sweep_scratch_create(struct sweep_scratch *out, int width);
void sweep_scratch_free(struct sweep_scratch *scratch);

// Costs of one row for one disparity, SWEEP_SCALE x the mean truncated difference of the channels:
// the least over the sides, and (or NULL) the mean over all cameras.
void sweep_row(uint8_t *least, uint8_t *mean, const struct sweep *sweep,
               const struct sweep_target *target, double disparity, int row,
               const struct sweep_scratch *scratch);

#endif
