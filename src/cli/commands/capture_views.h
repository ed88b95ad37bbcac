// capture_views.h - what lightfield and panorama share
#ifndef CLI_CAPTURE_VIEWS_H
#define CLI_CAPTURE_VIEWS_H

#include "cli/cli.h"

struct views_options {
    const char *output, *lights;
    struct relume_transfer transfer;
    double depth_range[2];
    bool force;
};
// Table rows for a command's options; `views` in its struct.
// clang-format off
#define VIEWS_OPTIONS                                                                              \
    GROUP("output"),                                                                               \
    OUTPUT(OPTION_OUTPUT, views.output, "DIR", "the capture folder to make"),                      \
    FLAG("--force", views.force, "replace a folder that relume made"),                             \
    GROUP("input"),                                                                                \
    TRANSFER("--transfer", views.transfer, "linear, srgb or gamma:G; default: by file"),           \
    GROUP("lights"),                                                                               \
    TEXT("--lights", views.lights, "FILE",                                                         \
         "the lights are known: a .lp, .dome or capture.json file, or lines x y z")
// clang-format on

// The lights belong to `*lights`, which the caller frees.
relume_status ingest_params(struct relume_ingest_params *out, struct relume_vec3 **lights,
                            const struct args *args, const struct views_options *options);
// That folder `dir` is made and what may be done with it.
void say_next(const struct args *args, const char *dir, const char *what);

#endif
