// frame_options.h - what `relight` and `query` share: lights, depth, kernels
#ifndef CLI_FRAME_OPTIONS_H
#define CLI_FRAME_OPTIONS_H

#include "cli.h"

struct light_options {
    struct texts light;
    const char *rig, *save_rig;
    double assume_depth;
};
// Table rows for a command's options; `lighting` in its struct.
#define LIGHT_OPTIONS                                                                              \
    TEXTS("--light", lighting.light, "lights", "SPEC",                                             \
          "\"dir x y z\", point, spot, slide, area, env, ies, gonio (docs/lights.md); repeats; "   \
          "default: \"dir 0 0 1\""),                                                               \
        TEXT("--rig", lighting.rig, "lights", "FILE",                                              \
             "lights of a rig (JSON), before those of --light"),                                   \
        TEXT_AS(OPTION_OUTPUT, "--save-rig", lighting.save_rig, "lights", "FILE",                  \
                "write all lights as a rig"),                                                      \
        NUMBER("--assume-depth", lighting.assume_depth, "lights", "D",                             \
               "near lights, file without depth: assume the surface this far from the eye", 1e-6,  \
               1e9)
struct interpolate_options {
    const char *name;
    bool nearest;
};
// `interpolation` in its struct.
#define INTERPOLATE_OPTIONS                                                                        \
    TEXT("--interpolate", interpolation.name, "camera", "I",                                       \
         "slab: constant, linear or depth; default: depth where the file has it, else linear"),    \
        FLAG("--nearest", interpolation.nearest, "camera",                                         \
             "slab: the same as --interpolate constant")
#define CPU_OPTION                                                                                 \
    INT("--cpu-mask", cpu_mask, "machine", "M", "CPU features to use, 0: plain C; default: all",   \
        0, 65535)

#define SIZE_HELP                                                                                  \
    "size of the picture: WxH, W (or Wx) or xH; one alone keeps the proportions, both add black "  \
    "borders if the proportions differ"

// --size: of one side alone the other one is 0; both are 0 without it.
relume_status parse_size(const char *text, int *width, int *height);
// The lights of --rig and --light, "dir 0 0 1" where both are missing; --save-rig is obeyed. They
// belong to `*rig`, which is to be destroyed.
relume_status parse_lights(const struct args *args, const struct light_options *options,
                           relume_rig **rig, const struct relume_light **lights, int *count);
// --interpolate and --nearest, not both.
relume_status parse_interpolation(const struct interpolate_options *options,
                                  struct relume_frame_params *params);
// Threads, kernels (a `cpu_mask` of ALL_KERNELS is the default) and depth; the log is still to be
// set.
enum { ALL_KERNELS = -1 };
struct relume_frame_params parse_frame(const struct args *args, const struct light_options *options,
                                       int cpu_mask);

#endif
