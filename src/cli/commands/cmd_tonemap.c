// cmd_tonemap.c - relume tonemap: an HDR picture for a screen
#include "cli.h"
#include "develop.h"

struct tonemap_options {
    struct args args;
    const char *output;
    struct develop_options develop;
};
#define OPTIONS struct tonemap_options

static const struct option options[] = {
    TEXT_AS(OPTION_PICTURE, "-o", output, "output", "OUT",
            "picture to write: .png, .jpg, .tif, ..."),
    TEXT("--exposure", develop.exposure, "picture", "EV",
         "brighter by EV stops (times 2^EV), or auto: mid grey; default: auto"),
    TEXT("--tone", develop.tone, "picture", "T",
         "reinhard (default), filmic, gamma or linear (clip); .exr, .hdr and .pfm stay linear"),
    NUMBER("--white", develop.white, "picture", "L",
           "reinhard: the luminance shown as white; default: 4", 1e-3, 1e6),
    {0},
};

static relume_status run(const struct args *args)
{
    const struct tonemap_options *o = (const void *)args;
    const char *output = o->output;
    struct developing developing;
    struct relume_image image = {0};
    if (!output)
        return usage_error("tonemap: expected -o OUT");
    relume_status status = parse_developing(&o->develop, &developing);
    if (!status)
        status = relume_photograph_load(&image, NULL, o->args.input[0],
                                        relume_photograph_params(.log = o->args.log));
    if (!status)
        status = develop(&image, developing, output);
    if (!status)
        status = relume_image_save(&image, output, relume_image_params(.log = o->args.log));
    relume_image_destroy(&image);
    return status;
}

const struct command command_tonemap = {
    .name = "tonemap",
    .usage = "IN -o OUT [OPTION ...]",
    .summary = "turn an HDR picture into one for the screen: exposure and tone curve",
    .example = "relume tonemap church.hdr -o church.png --exposure -1",
    .min_inputs = 1,
    .max_inputs = 1,
    .options = options,
    .size = sizeof(struct tonemap_options),
    .defaults =
        &(const struct tonemap_options){.develop = {.exposure = "auto", .tone = "reinhard"}},
    .run = run,
};
