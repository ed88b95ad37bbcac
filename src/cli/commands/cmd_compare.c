// cmd_compare.c - relume compare: how different two pictures are
#include "cli.h"

#include <math.h>

struct compare_options {
    struct args args;
    const char *output;
    bool ramps, json;
};
#define OPTIONS struct compare_options

static const struct option options[] = {
    GROUP("output"),
    TEXT_AS(OPTION_PICTURE, "-o", output, "OUT",
            "write the difference |A - B| as a picture in linear light"),
    FLAG("--ramps", ramps, "also measure banding: how well B keeps smooth gradients"),
    FLAG("--json", json, "one JSON object"),
    {0},
};

static void print(const struct compare_options *o, const struct relume_difference *d,
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
    const size_t count = sizeof rows / sizeof *rows - !o->ramps;
    for (size_t i = 0; i < count; i++) {
        if (!o->json && isfinite(rows[i].value))
            printf("%-8s %.6g\n", rows[i].name, rows[i].value);
        else if (!o->json)
            printf("%-8s -\n", rows[i].name);
        if (!o->json)
            continue;
        printf("%s\"%s\": ", i ? ", " : "{", rows[i].name);
        json_number(stdout, rows[i].value);
    }
    if (o->json)
        puts("}");
}

static relume_status run(const struct args *args)
{
    const struct compare_options *o = (const void *)args;
    struct relume_image a = {0}, b = {0};
    struct relume_difference difference;
    struct relume_ramps ramps = {0};
    const struct relume_image_params *load = relume_image_params(.log = o->args.log);
    relume_status status = relume_image_load(&a, o->args.input[0], load);
    if (!status)
        status = relume_image_load(&b, o->args.input[1], load);
    if (!status && (a.width != b.width || a.height != b.height))
        status = data_error("%s: %d x %d pixels; expected %d x %d as in %s", o->args.input[1],
                            b.width, b.height, a.width, a.height, o->args.input[0]);
    if (!status)
        status = relume_image_compare(&difference, &a, &b,
                                      relume_compare_params(.threads = o->args.threads));
    if (!status && o->ramps)
        status =
            relume_image_ramps(&ramps, &a, &b, relume_compare_params(.threads = o->args.threads));
    for (size_t i = 0; !status && i < 3 * (size_t)a.width * (size_t)a.height; i++)
        a.data[i] = fabsf(a.data[i] - b.data[i]);
    if (!status && o->output)
        status = relume_image_save(&a, o->output, load);
    if (!status)
        print(o, &difference, &ramps);
    relume_image_destroy(&a);
    relume_image_destroy(&b);
    return status;
}

const struct command command_compare = {
    COMMAND("compare", "A B [-o OUT] [--ramps] [--json]", "measure how different two pictures are",
            "relume compare relit.exr photograph.jpg --json", 2, 2),
};
