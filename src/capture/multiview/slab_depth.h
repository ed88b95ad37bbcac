// slab_depth.h - what the steps of relume_slab_depth share
#ifndef MULTIVIEW_SLAB_DEPTH_H
#define MULTIVIEW_SLAB_DEPTH_H

#include "capture/multiview/plane_sweep.h"

#include <relume/capture/slab_depth.h>

enum { DEPTH_LIGHTS = 4 };

struct slab_depth {
    const relume_capture *capture;
    const struct relume_manifest *m;
    struct relume_slab_depth_params p;
    struct plane_sweep sweep;
    uint8_t **picture;  // [views]
    double (*at)[2];    // [views]
    int factor;         // pixels to a texel
    int lights, light[DEPTH_LIGHTS];
    int planes;
    double first, step;  // disparities of planes
    float **plane;       // [views], [height][width]: what was found, in planes
    void *memory;        // pictures and planes
    size_t memory_bytes;
    // of the comparison with known depth, bins of relative error
    size_t *bins, compared, bad;
    double trusted;
};

// Load all views. An input status, RELUME_ENOMEM.
relume_status slab_depth_load(struct slab_depth *d, const char *near);
// Choose planes by `range`, or by looking at some rows of the middle view.
relume_status slab_depth_planes(struct slab_depth *d);
// Sweep, smooth and choose: plane[view].
relume_status slab_depth_view(struct slab_depth *d, int view);

// Check a view's planes by its neighbours: confidence[height][width] in [0, 1], and what they
// contradict replaced in out[height][width].
void slab_depth_confirm(float *out, float *confidence, const struct slab_depth *d, int view);

#endif
