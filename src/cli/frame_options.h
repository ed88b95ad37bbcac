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
// clang-format off
#define LIGHT_OPTIONS                                                                              \
    TEXTS("--light", lighting.light, "SPEC",                                                       \
          "\"dir x y z\", point, spot, slide, area, env, ies, gonio (docs/lights.md); repeats; "   \
          "default: \"dir 0 0 1\""),                                                               \
    TEXT("--rig", lighting.rig, "FILE", "lights of a rig (JSON), before those of --light"),        \
    TEXT_AS(OPTION_RIG, "--save-rig", lighting.save_rig, "FILE", "write all lights as a rig"),  \
    NUMBER("--assume-depth", lighting.assume_depth, "D",                                           \
           "near lights, file without depth: assume the surface this far from the eye", 1e-6, 1e9)
// `interpolation` and `nearest` in its struct.
#define INTERPOLATE_OPTIONS                                                                        \
    NAME("--interpolate", interpolation, "I",                                                      \
         "slab: constant, linear or depth; default: depth where the file has it, else linear",     \
         RELUME_INTERPOLATE_CONSTANT, "constant", "linear", "depth"),                              \
    FLAG("--nearest", nearest, NULL)
#define CPU_OPTION                                                                                 \
    INT("--cpu-mask", cpu_mask, "M", "CPU features to use, 0: plain C; default: all", 0, 65535)
// clang-format on

// The lights of --rig and --light, "dir 0 0 1" where both are missing. They belong to `*rig`,
// which the caller destroys.
relume_status parse_lights(const struct args *args, const struct light_options *options,
                           relume_rig **rig, const struct relume_light **lights, int *count);
// What --save-rig asks for, once all else is done: who fails leaves no rig.
relume_status save_lights(const struct args *args, const struct light_options *options,
                          const relume_rig *rig);
// Threads, kernels (a `cpu_mask` of ALL_KERNELS is the default) and depth; the log is still to be
// set.
enum { ALL_KERNELS = -1 };
struct relume_frame_params parse_frame(const struct args *args, const struct light_options *options,
                                       int cpu_mask);

#endif
