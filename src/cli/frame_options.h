// frame_options.h - what `relight` and `query` share: lights, camera, kernels
#ifndef CLI_FRAME_OPTIONS_H
#define CLI_FRAME_OPTIONS_H

#include "cli.h"

// Table rows for a command's options.
#define LIGHT_OPTION                                                                               \
    {                                                                                              \
        "--light", OPTION_TEXT, "SPEC",                                                            \
            "\"dir x y z [rgb r g b]\"; repeats; default: \"dir 0 0 1\"", 0, 0                     \
    }
#define CPU_OPTION                                                                                 \
    {                                                                                              \
        "--cpu-mask", OPTION_INT, "M", "CPU features to use, 0: plain C; default: all", 0, 65535   \
    }

// `*lights` is to be freed.
relume_status parse_lights(const struct args *args, struct relume_light **lights, int *count);
unsigned parse_cpu_off(const struct args *args);

#endif
