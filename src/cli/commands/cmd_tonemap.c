// cmd_tonemap.c - relume tonemap: an HDR picture for a screen
#include "cli/develop.h"

#include <math.h>

struct tonemap_options {
    struct args args;
    const char *output;
    struct develop_options develop;
};
#define OPTIONS struct tonemap_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_PICTURE, output, "OUT", "picture to write: .png, .jpg, .tif, ..."),
    GROUP("picture"),
    DEVELOP_ROWS("brighter by EV stops (times 2^EV), or auto, by the picture; default: auto",
                 "reinhard (default), filmic, gamma or linear (clip); .exr, .hdr and .pfm stay "
                 "linear"),
    {0},
};

static relume_status run_tonemap(const struct args *args)
{
    const struct tonemap_options *o = (const void *)args;
    struct relume_image image = {0};
    relume_status status = relume_photograph_load(&image, NULL, args->input[0],
                                                  relume_photograph_params(.log = args->log));
    if (!status)
        status = develop(&image, &o->develop, o->output);
    if (!status)
        status = save_developed(&image, &o->develop, o->output, args);
    relume_image_destroy(&image);
    return status;
}

const struct command command_tonemap = {
    COMMAND(run_tonemap, "tonemap", "IN -o OUT [OPTION ...]",
            "turn an HDR picture into one for the screen: exposure and tone curve",
            "relume tonemap church.hdr -o church.png --exposure -1", 1, 1),
    .defaults =
        &(const OPTIONS){.develop = {.exposure = (double)NAN, .tone = &relume_tone_reinhard}},
};
