// cmd_compare.c - relume compare: how different two pictures are
#include "cli/commands/compare_seen.h"

#include <math.h>

struct compare_options {
    struct args args;
    const char *output;
    bool ramps, json, jnd;
    enum compare_metric metric;
    struct compare_look look;
};
#define OPTIONS struct compare_options

static const struct option options[] = {
    GROUP("output"),
    TEXT_AS(OPTION_PICTURE, "-o", output, "OUT",
            "write the difference |A - B| as a picture in linear light"),
    FLAG("--ramps", ramps, "also measure banding: how well B keeps smooth gradients"),
    FLAG("--json", json, "one JSON object"),
    GROUP("what people see"),
    NAME("--metric", metric, "M",
         "jnd: in just noticeable differences; vdp: how likely it is seen; -o writes the map",
         COMPARE_JND, "jnd", "vdp"),
    FLAG("--jnd", jnd, NULL),
    NUMBER("--pixels-per-degree", look.ppd, "P",
           "of the viewer's sight; default 40, a desktop screen at 60 cm", 1, 1000),
    NUMBER("--luminance", look.white, "CD", "of white, in candela per square metre; default 200",
           0.01, 1e6),
    GROUP("a photograph and a rendering"),
    TEXT("--mask", look.mask, "PICTURE", "compare only where it is white"),
    FLAG("--register", look.align, "align B with A first"),
    FLAG("--fit-colours", look.colours, "bring B's colours to A's by the best 3 x 3 matrix"),
    INT("--reduce", look.reduce, "N", "compare at a size N times smaller", 1, 64),
    FLAG("--grey", look.grey, "compare grey pictures of equal mean brightness"),
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
    struct jwriter w = json_to(stdout);
    if (o->json)
        jopen_object(&w, NULL);
    for (size_t i = 0; i < count; i++) {
        if (o->json)
            jput_number(&w, rows[i].name, rows[i].value, 9);
        else if (isfinite(rows[i].value))
            printf("%-8s %.6g\n", rows[i].name, rows[i].value);
        else
            printf("%-8s -\n", rows[i].name);
    }
    if (o->json)
        jend(&w);
}

// `a` becomes the difference.
static relume_status measure(struct relume_image *a, const struct relume_image *b,
                             const struct relume_image *mask, const struct compare_options *o)
{
    const struct relume_compare_params *p =
        relume_compare_params(.threads = o->args.threads, .mask = mask->data ? mask : NULL);
    struct relume_difference difference;
    struct relume_ramps ramps = {0};
    relume_status status = relume_image_compare(&difference, a, b, p);
    if (!status && o->ramps)
        status = relume_image_ramps(&ramps, a, b, p);
    for (size_t i = 0; !status && i < 3 * (size_t)a->width * (size_t)a->height; i++)
        a->data[i] = fabsf(a->data[i] - b->data[i]);
    if (!status && o->output)
        status = relume_image_save(a, o->output, relume_image_params(.log = o->args.log));
    if (!status)
        print(o, &difference, &ramps);
    return status;
}

static relume_status look_at(const struct relume_image *a, const struct relume_image *b,
                             const struct relume_image *mask, const struct compare_options *o)
{
    struct compare_seen seen = {.metric = o->metric ? o->metric : COMPARE_JND};
    relume_status status = compare_look_at(&seen, a, b, mask, &o->look, &o->args);
    if (!status && o->output)
        status = compare_save_map(&seen, o->output, &o->args);
    if (!status)
        compare_print_seen(&seen, o->json);
    compare_seen_free(&seen);
    return status;
}

static relume_status run_compare(const struct args *args)
{
    const struct compare_options *o = (const void *)args;
    const bool seen = o->metric || o->jnd;
    struct relume_image a = {0}, b = {0}, mask = {0};
    const struct relume_image_params *load = relume_image_params(.log = o->args.log);
    if (o->jnd && o->metric == COMPARE_VDP)
        return usage_error("--jnd and --metric vdp: choose one of them");
    if (seen && o->ramps)
        return usage_error("--ramps is not measured with --metric");
    if (!seen && (o->look.ppd > 0.0 || o->look.white > 0.0))
        return usage_error("--pixels-per-degree and --luminance need --metric");
    relume_status status = relume_image_load(&a, o->args.input[0], load);
    if (!status)
        status = relume_image_load(&b, o->args.input[1], load);
    if (!status && !o->look.align && (a.width != b.width || a.height != b.height))
        status = data_error("%s: %d x %d pixels; expected %d x %d as in %s", o->args.input[1],
                            b.width, b.height, a.width, a.height, o->args.input[0]);
    if (!status)
        status = compare_prepare(&a, &b, &mask, &o->look, args);
    if (!status)
        status = seen ? look_at(&a, &b, &mask, o) : measure(&a, &b, &mask, o);
    relume_image_destroy(&a);
    relume_image_destroy(&b);
    relume_image_destroy(&mask);
    return status;
}

const struct command command_compare = {
    COMMAND(run_compare, "compare", "A B [-o OUT] [--metric jnd|vdp] [OPTION ...]",
            "measure how different two pictures are",
            "relume compare relit.exr photograph.jpg --json", 2, 2),
};
