// slab_depth.h - depth of a light slab from its own views
#ifndef RELUME_SLAB_DEPTH_H
#define RELUME_SLAB_DEPTH_H

#include <relume/base.h>
#include <relume/capture.h>

#ifdef __cplusplus
extern "C" {
#endif

struct relume_slab_depth_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    double range[2];  // distances along z from the cameras' plane, nearest and farthest, world
                      // units; default: found in the middle view
    int planes;       // of disparity, 8 to 256; default: a texel of the farthest neighbour each
    int max_width;    // views are searched at most this wide; default 1024
    size_t memory;    // bytes for pictures and depths together; views are made smaller until they
                      // fit; default 2^30
    bool force;       // replace an existing folder
    int threads;      // default: all cores
};
#define relume_slab_depth_params(...)                                                              \
    (&(const struct relume_slab_depth_params){RELUME_SIZED(relume_slab_depth_params), __VA_ARGS__})

// How the estimate compares with the depth that the capture had. Zero when it had none.
struct relume_slab_depth_report {
    int views, planes, lights;  // lights: how many were used
    int width, height;          // at which views were searched
    double range[2];            // distances along z from the cameras' plane that were searched
    double plane_step;          // disparity (view.h) between planes
    double trusted;             // share of pixels that neighbouring views confirm
    size_t compared;            // pixels of finite true depth
    double median_relative;     // |estimate - truth| / truth
    double bad;                 // share that is off by more than one plane
};

// Write the folder `dir`: the slab `capture` with a depth image for every view (world units along
// the ray) and a confidence image beside it (0 to 1: the share of neighbouring views that confirm
// it), photographs named by relative paths. `report` may be NULL.
//
// Plane sweep over disparities with the nearest 24 cameras, the better half of them where something
// occludes (sweep.h), costs summed over up to four lights; semi-global matching (Hirschmueller
// 2008) in eight directions; a parabola between planes; what the neighbours contradict takes the
// depth of the farther trusted pixel beside it. Depth is found everywhere: background without
// texture is guessed; only a view's mask (below 0.5) makes it infinite. Equal input gives equal
// bytes for any number of threads. RELUME_EINVAL (not a slab of two views, params), an input
// status, RELUME_EIO, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_slab_depth(struct relume_slab_depth_report *report,
                                              const relume_capture *capture, const char *dir,
                                              const struct relume_slab_depth_params *params);

#ifdef __cplusplus
}
#endif
#endif
