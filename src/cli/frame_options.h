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
          "\"dir x y z\", \"raking SIDE\" or another light (docs/lights.md); default: \"dir 0 0 1\""), \
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
// The same for commands that call aim_lights once they have opened a file: --light may be "raking",
// which a direction stands in for.
relume_status parse_lights_of_file(const struct args *args, const struct light_options *options,
                                   relume_rig **rig, const struct relume_light **lights,
                                   int *count);
// Lets raking light come from captured lights of the file that show relief (relume_relief_lowest),
// and tells which. Updates `lights` and `count`. RELUME_EUNFIT for panoramas and
// several slabs, errors of relume_relief_find.
relume_status aim_lights(const struct args *args, const struct light_options *options,
                         relume_rig *rig, relume_pack *pack, const char *file,
                         const struct relume_light **lights, int *count);
// What --save-rig asks for, once all else is done: who fails leaves no rig.
relume_status save_lights(const struct args *args, const struct light_options *options,
                          const relume_rig *rig);
// Threads, kernels (a `cpu_mask` of ALL_KERNELS is the default) and depth; the log is still to be
// set.
enum { ALL_KERNELS = -1 };
struct relume_frame_params parse_frame(const struct args *args, const struct light_options *options,
                                       int cpu_mask);

#endif
