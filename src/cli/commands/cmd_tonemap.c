// cmd_tonemap.c - relume tonemap: an HDR picture for a screen
#include "cli.h"
#include "develop.h"

static const struct option options[] = {
    {"-o", OPTION_PICTURE, "OUT", "picture to write: .png, .jpg, .tif, ...", 0, 0},
    {"--exposure", OPTION_TEXT, "EV",
     "brighter by EV stops (times 2^EV), or auto: mid grey; default: auto", 0, 0},
    {"--tone", OPTION_TEXT, "T",
     "reinhard (default), filmic, gamma or linear (clip); .exr, .hdr and .pfm stay linear", 0, 0},
    {"--white", OPTION_NUMBER, "L", "reinhard: the luminance shown as white; default: 4", 1e-3,
     1e6},
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
};

static relume_status run(const struct args *args)
{
    const char *output = args_text(args, "-o", NULL);
    struct developing developing;
    struct relume_image image = {0};
    if (!output)
        return usage_error("tonemap: expected -o OUT");
    relume_status status = parse_developing_from(args, "auto", "reinhard", &developing);
    if (!status)
        status = relume_photograph_load(&image, NULL, args_input(args, 0),
                                        relume_photograph_params(.log = args_log(args)));
    if (!status)
        status = develop(&image, developing, output);
    if (!status)
        status = relume_image_save(&image, output, relume_image_params(.log = args_log(args)));
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
    .run = run,
};
