// cmd_eval.c - relume eval: a file against every image of a capture
#include "cli/cli.h"

#include <math.h>
#include <string.h>

struct eval_options {
    struct args args;
    struct relume_transfer transfer;
    double assume_depth;
    bool skip_missing, json, allow_outside, jnd;
};
#define OPTIONS struct eval_options

static const struct option options[] = {
    GROUP("input"),
    TRANSFER("--transfer", transfer, "linear, srgb or gamma:G; overrides the capture's"),
    FLAG("--skip-missing", skip_missing, "leave out lights whose image does not exist"),
    ALLOW_OUTSIDE_OPTION,
    GROUP("lights"),
    NUMBER("--assume-depth", assume_depth, "D",
           "near lights, capture without depth: assume the surface this far from the eye", 1e-6,
           1e9),
    GROUP("output"),
    FLAG("--json", json, "one JSON object"),
    FLAG("--jnd", jnd, "also what people see of the differences, in just noticeable ones"),
    {0},
};

static void print_json(const struct relume_evaluation *e)
{
    const struct {
        const char *name;
        double value;
    } rows[] = {
        {"rms", e->rms},
        {"psnr_db", e->psnr_db},
        {"psnr_pooled_db", e->psnr_pooled_db},
        {"ssim", e->ssim},
        {"delta_e", e->delta_e},
        {"jnd_99", e->jnd},
        {"jnd_99_worst", e->jnd_worst},
        {"file_bytes", e->file_bytes},
        {"bits_per_pixel", e->bits_per_pixel},
        {"raw_bytes", e->raw_bytes},
        {"ratio", e->ratio},
    };
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_integer(&w, "views", e->views);
    jput_integer(&w, "lights", e->lights);
    jput_integer(&w, "width", e->width);
    jput_integer(&w, "height", e->height);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (strncmp(rows[i].name, "jnd", 3) || isfinite(rows[i].value))
            json_measure(&w, rows[i].name, rows[i].value);
    jopen_array(&w, "per_light");
    for (int i = 0; i < e->lights; i++) {
        jopen_object(&w, NULL);
        jput_number(&w, "rms", e->light[i].rms, 9);
        jput_number(&w, "psnr_db", e->light[i].psnr_db, 9);
        jclose(&w);
    }
    jend(&w);
}

static void print_text(const struct relume_evaluation *e)
{
    int worst = 0;
    for (int i = 1; i < e->lights; i++)
        worst = e->light[i].psnr_db < e->light[worst].psnr_db ? i : worst;
    printf("images    %zu (%d view%s x %d light%s)\n", e->images, e->views, relume_plural(e->views),
           e->lights, relume_plural(e->lights));
    printf("PSNR      %.2f dB (mean over images): differences %s\n", e->psnr_db,
           judgement(e->psnr_db));
    if (e->lights > 1)
        printf("worst     %.2f dB (light %d): differences %s\n", e->light[worst].psnr_db, worst + 1,
               judgement(e->light[worst].psnr_db));
    if (isfinite(e->ssim))
        printf("SSIM      %.4f\n", e->ssim);
    printf("deltaE    %.3f (CIEDE2000)\n", e->delta_e);
    if (isfinite(e->jnd))
        printf("JND       %.2f (1 %% of the pixels exceed it; mean over images), worst %.2f\n",
               e->jnd, e->jnd_worst);
    printf("RMS       %.5f (linear)\n", e->rms);
    printf("file      %.0f bytes, %.3f bits per pixel and view\n", e->file_bytes,
           e->bits_per_pixel);
}

static relume_status run_eval(const struct args *args)
{
    const struct eval_options *o = (const void *)args;
    relume_pack *pack = NULL;
    relume_capture *capture = NULL;
    struct relume_evaluation evaluation = {0};
    relume_status status =
        relume_pack_open(&pack, o->args.input[0],
                         relume_pack_params(.log = o->args.log, .threads = o->args.threads));
    if (!status)
        status = relume_capture_open_photographs(
            &capture, o->args.input[1],
            relume_capture_params(.log = o->args.log, .transfer = o->transfer,
                                  .skip_missing = o->skip_missing,
                                  .allow_outside = o->allow_outside,
                                  .assume_depth = o->assume_depth),
            NULL, NULL);
    if (!status)
        status =
            relume_evaluate(&evaluation, pack, capture,
                            relume_evaluate_params(.log = o->args.log, .file = o->args.input[0],
                                                   .capture = o->args.input[1],
                                                   .threads = o->args.threads, .jnd = o->jnd));
    if (!status)
        (o->json ? print_json : print_text)(&evaluation);
    relume_evaluation_destroy(&evaluation);
    relume_capture_destroy(&capture);
    relume_pack_destroy(&pack);
    return status;
}

const struct command command_eval = {
    COMMAND(
        run_eval, "eval", "FILE CAPTURE [--json]",
        "relight a file with every light of a capture and compare the results with its photographs",
        "relume eval statue.exr photos/heldout.lp --json", 2, 2),
};
