// frame_options.h - what `relight` and `query` share: lights, depth, kernels
#ifndef CLI_FRAME_OPTIONS_H
#define CLI_FRAME_OPTIONS_H

#include "cli.h"

// Table rows for a command's options.
#define LIGHT_OPTIONS                                                                              \
    {"--light",                                                                                    \
     OPTION_TEXT,                                                                                  \
     "SPEC",                                                                                       \
     "\"dir x y z\", point, spot, slide, area, env, ies, gonio (docs/lights.md); repeats; "        \
     "default: "                                                                                   \
     "\"dir 0 0 1\"",                                                                              \
     0,                                                                                            \
     0},                                                                                           \
        {"--rig", OPTION_TEXT, "FILE", "lights of a rig (JSON), before those of --light", 0, 0},   \
        {"--save-rig", OPTION_OUTPUT, "FILE", "write all lights as a rig", 0, 0},                  \
    {                                                                                              \
        "--assume-depth", OPTION_NUMBER, "D",                                                      \
            "near lights, file without depth: assume the surface this far from the eye", 1e-6, 1e9 \
    }
#define INTERPOLATE_OPTIONS                                                                        \
    {"--interpolate",                                                                              \
     OPTION_TEXT,                                                                                  \
     "I",                                                                                          \
     "slab: constant, linear or depth; default: depth where the file has it, else linear",         \
     0,                                                                                            \
     0},                                                                                           \
    {                                                                                              \
        "--nearest", OPTION_FLAG, NULL, "slab: the same as --interpolate constant", 0, 0           \
    }
#define CPU_OPTION                                                                                 \
    {                                                                                              \
        "--cpu-mask", OPTION_INT, "M", "CPU features to use, 0: plain C; default: all", 0, 65535   \
    }

#define SIZE_HELP                                                                                  \
    "size of the picture: WxH, W (or Wx) or xH; one alone keeps the proportions, both add black "  \
    "borders if the proportions differ"

// --size: of one side alone the other one is 0; both are 0 without it.
relume_status parse_size(const struct args *args, int *width, int *height);
// The lights of --rig and --light, "dir 0 0 1" where both are missing; --save-rig is obeyed. They
// belong to `*rig`, which is to be destroyed.
relume_status parse_lights(const struct args *args, relume_rig **rig,
                           const struct relume_light **lights, int *count);
// --interpolate and --nearest, not both.
relume_status parse_interpolation(const struct args *args, struct relume_frame_params *params);
// Threads, kernels and depth; the log is still to be set.
struct relume_frame_params parse_frame(const struct args *args);

#endif
