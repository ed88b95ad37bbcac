// cmd_compare.c - relume compare: how different two pictures are
#include "cli.h"

#include <math.h>

static const struct option options[] = {
    {"-o", OPTION_PICTURE, "OUT", "write the difference |A - B| as a picture in linear light", 0,
     0},
    {"--ramps", OPTION_FLAG, NULL, "also measure banding: how well B keeps smooth gradients", 0, 0},
    {"--json", OPTION_FLAG, NULL, "one JSON object", 0, 0},
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
};

static void print(const struct args *args, const struct relume_difference *d,
                  const struct relume_ramps *ramps)
{
    const struct {
        const char *name;
        double value;
    } rows[] = {
        {"rms", d->rms},
        {"psnr_db", d->psnr_db},
        {"ssim", d->ssim},
        {"delta_e", d->delta_e},
        {"max_abs", d->max_abs},
        {"ramp_error", ramps->slope > 0.0 ? sqrt(ramps->error / ramps->slope) : (double)NAN}};
    const size_t count = sizeof rows / sizeof *rows - !args_has(args, "--ramps");
    const bool json = args_has(args, "--json");
    for (size_t i = 0; i < count; i++) {
        if (!json && isfinite(rows[i].value))
            printf("%-8s %.6g\n", rows[i].name, rows[i].value);
        else if (!json)
            printf("%-8s -\n", rows[i].name);
        if (!json)
            continue;
        printf("%s\"%s\": ", i ? ", " : "{", rows[i].name);
        json_number(stdout, rows[i].value);
    }
    if (json)
        puts("}");
}

// Of equal sizes; in place of `a`.
static relume_status save_difference(const struct args *args, struct relume_image *a,
                                     const struct relume_image *b)
{
    const size_t samples = 3 * (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < samples; i++)
        a->data[i] = fabsf(a->data[i] - b->data[i]);
    return relume_image_save(a, args_text(args, "-o", NULL),
                             relume_image_params(.log = args_log(args)));
}

static relume_status run(const struct args *args)
{
    struct relume_image a = {0}, b = {0};
    struct relume_difference difference;
    struct relume_ramps ramps = {0};
    const struct relume_image_params *load = relume_image_params(.log = args_log(args));
    relume_status status = relume_image_load(&a, args_input(args, 0), load);
    if (!status)
        status = relume_image_load(&b, args_input(args, 1), load);
    if (!status && (a.width != b.width || a.height != b.height))
        status = data_error("%s: %d x %d pixels; expected %d x %d as in %s", args_input(args, 1),
                            b.width, b.height, a.width, a.height, args_input(args, 0));
    if (!status)
        status = relume_image_compare(&difference, &a, &b,
                                      relume_compare_params(.threads = args_threads(args)));
    if (!status && args_has(args, "--ramps"))
        status = relume_image_ramps(&ramps, &a, &b,
                                    relume_compare_params(.threads = args_threads(args)));
    if (!status && args_has(args, "-o"))
        status = save_difference(args, &a, &b);
    if (!status)
        print(args, &difference, &ramps);
    relume_image_destroy(&a);
    relume_image_destroy(&b);
    return status;
}

const struct command command_compare = {
    .name = "compare",
    .usage = "A B [-o OUT] [--ramps] [--json]",
    .summary = "measure how different two pictures are",
    .example = "relume compare relit.exr photograph.jpg --json",
    .min_inputs = 2,
    .max_inputs = 2,
    .options = options,
    .run = run,
};
