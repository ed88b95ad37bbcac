// capture_views.h - what lightfield and panorama share
#ifndef CLI_CAPTURE_VIEWS_H
#define CLI_CAPTURE_VIEWS_H

#include "cli.h"

struct views_options {
    const char *output, *transfer, *lights, *depth_range;
    bool force;
};
// Table rows for a command's options; `views` in its struct.
// clang-format off
#define VIEWS_OPTIONS \
    TEXT_AS(OPTION_OUTPUT, "-o", views.output, "output", "DIR", "the capture folder to make"), \
    FLAG("--force", views.force, "output", "replace a folder that relume made"), \
    TEXT("--transfer", views.transfer, "input", "T", "linear, srgb or gamma:G; default: by file"), \
    TEXT("--lights", views.lights, "lights", "FILE", \
         "the lights are known: a .lp, .dome or capture.json file, or lines x y z")
// clang-format on

// The lights belong to `*lights`, which is to be freed. RELUME_EINVAL with a sentence.
relume_status ingest_params(struct relume_ingest_params *out, struct relume_vec3 **lights,
                            const struct args *args, const struct views_options *options);
// That folder `dir` is made and what may be done with it.
void say_next(const struct args *args, const char *dir, const char *what);
// "A,B" of --depth-range; what is not given stays.
relume_status parse_depth_range(double range[2], const struct views_options *options);

#endif
