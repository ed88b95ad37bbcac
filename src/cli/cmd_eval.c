#include "cli.h"

#include <math.h>
#include <stdlib.h>

static const struct option options[] = {
    {"--transfer", OPTION_TEXT, "T", "linear, srgb or gamma:G; overrides the capture's", 0, 0},
    {"--skip-missing", OPTION_FLAG, NULL, "leave out lights whose image does not exist", 0, 0},
    {"--json", OPTION_FLAG, NULL, "one JSON object", 0, 0},
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
};

// Sums over the views of one light.
struct light_sums {
    double square, psnr;  // linear squared error x pixels; sum of dB
    size_t pixels, images;
};

struct evaluation {
    const struct args *args;
    relume_pack *pack;
    relume_capture *capture;
    const struct relume_manifest *manifest;
    const struct relume_pack_info *info;
    struct relume_transfer display;
    struct light_sums *light;  // [lights]
    double square, mse, psnr, ssim, delta_e;
    size_t pixels, images, structured;
};

// The stored view that stands where a captured one does, -1 when there is none.
static int matching_view(const struct evaluation *e, int view)
{
    if (e->info->geometry.projection != RELUME_SLAB)
        return view < e->info->views ? view : -1;
    const double *uv = e->manifest->view[view].uv;
    for (int i = 0; i < e->info->views; i++)
        if (fabs(e->info->uv[i][0] - uv[0]) <= 1e-6 && fabs(e->info->uv[i][1] - uv[1]) <= 1e-6)
            return i;
    return -1;
}

static struct relume_camera camera_for(const struct evaluation *e, int view)
{
    const int match = matching_view(e, view);
    if (match >= 0)
        return (struct relume_camera){.framing = RELUME_FRAME_VIEW, .view = match};
    const double *uv = e->manifest->view[view].uv;
    return (struct relume_camera){.framing = RELUME_FRAME_EYE,
                                  .eye = {uv[0], uv[1], e->manifest->geometry.uv_z}};
}

static void add(struct evaluation *e, int light, const struct relume_difference *d)
{
    struct light_sums *s = &e->light[light];
    const double square = d->rms * d->rms * (double)d->pixels;
    if (d->pixels == 0)
        return;
    s->square += square;
    s->psnr += d->psnr_db;
    s->pixels += d->pixels;
    s->images++;
    e->square += square;
    e->mse += d->mse * (double)d->pixels;
    e->psnr += d->psnr_db;
    e->delta_e += d->delta_e;
    e->pixels += d->pixels;
    e->images++;
    if (isfinite(d->ssim)) {
        e->ssim += d->ssim;
        e->structured++;
    }
}

static relume_status evaluate_image(struct evaluation *e, int view, int light,
                                    const struct relume_camera *camera,
                                    const struct relume_image *mask)
{
    struct relume_light lamp = {.direction = e->manifest->directions[light],
                                .rgb = {1.0f, 1.0f, 1.0f}};
    if (e->manifest->positions) {
        lamp.kind = RELUME_LIGHT_POINT;
        lamp.position = e->manifest->positions[light];
    }
    struct relume_image captured = {0}, relit = {0};
    struct relume_difference difference;
    struct prefix_log about;
    relume_status status =
        relume_capture_image(&captured, e->capture, view, light, args_log(e->args));
    if (!status)
        status = relume_frame(&relit, e->pack, camera, &lamp, 1,
                              relume_frame_params(.log = prefix_log(&about, args_log(e->args),
                                                                    args_input(e->args, 0)),
                                                  .threads = args_threads(e->args)));
    if (!status)
        status = relume_image_compare(&difference, &relit, &captured,
                                      relume_compare_params(.mask = mask, .display = e->display,
                                                            .threads = args_threads(e->args)));
    if (!status)
        add(e, light, &difference);
    relume_image_destroy(&captured);
    relume_image_destroy(&relit);
    return status;
}

static relume_status evaluate_view(struct evaluation *e, int view)
{
    const struct relume_camera camera = camera_for(e, view);
    const struct relume_log *log = args_log(e->args);
    struct relume_image mask;
    relume_status status = relume_capture_mask(&mask, e->capture, view, log);
    for (int light = 0; !status && light < e->manifest->lights; light++) {
        status = evaluate_image(e, view, light, &camera, &mask);
        const double done = (view + (light + 1.0) / e->manifest->lights) / e->manifest->views;
        if (!status && !log->progress(log->user, "evaluating", done))
            status = RELUME_ECANCEL;
    }
    if (camera.framing == RELUME_FRAME_VIEW)
        relume_pack_drop(e->pack, camera.view);
    relume_image_destroy(&mask);
    return status;
}

static relume_status check_fit(const struct evaluation *e, const char *path)
{
    const int width = relume_capture_width(e->capture), height = relume_capture_height(e->capture);
    const enum relume_projection theirs = e->manifest->geometry.projection;
    const enum relume_projection ours = e->info->geometry.projection;
    if (width != e->info->width || height != e->info->height)
        return data_error("%s: %d x %d pixels; expected %d x %d as in the file", path, width,
                          height, e->info->width, e->info->height);
    if (theirs != ours)
        return data_error("%s: a %s capture; expected %s as in the file", path,
                          relume_projection_name(theirs), relume_projection_name(ours));
    if (ours != RELUME_SLAB && e->manifest->views > e->info->views)
        return data_error("%s: %d views; expected at most %d as in the file", path,
                          e->manifest->views, e->info->views);
    return RELUME_OK;
}

static double ratio(double a, double b)
{
    return b > 0.0 ? a / b : (double)NAN;
}

static void print_json(const struct evaluation *e)
{
    const int width = e->info->width, height = e->info->height;
    const double view_pixels = (double)e->info->views * width * height;
    const double raw = (double)e->manifest->views * e->manifest->lights * width * height * 12.0;
    const double mse = ratio(e->mse, (double)e->pixels);
    const struct {
        const char *name;
        double value;
    } rows[] = {
        {"rms", sqrt(ratio(e->square, (double)e->pixels))},
        {"psnr_db", ratio(e->psnr, (double)e->images)},
        {"psnr_pooled_db", mse > 1e-20  ? -10.0 * log10(mse)
                           : mse >= 0.0 ? 200.0
                                        : mse},
        {"ssim", ratio(e->ssim, (double)e->structured)},
        {"delta_e", ratio(e->delta_e, (double)e->images)},
        {"file_bytes", (double)e->info->file_bytes},
        {"bits_per_pixel", 8.0 * (double)e->info->file_bytes / view_pixels},
        {"raw_bytes", raw},
        {"ratio", raw / (double)e->info->file_bytes},
    };
    printf("{\"views\": %d, \"lights\": %d, \"width\": %d, \"height\": %d", e->manifest->views,
           e->manifest->lights, width, height);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        printf(", \"%s\": ", rows[i].name);
        if (rows[i].value == floor(rows[i].value))
            printf("%.0f", rows[i].value);
        else
            json_number(stdout, rows[i].value);
    }
    printf(", \"per_light\": [");
    for (int i = 0; i < e->manifest->lights; i++) {
        const struct light_sums *s = &e->light[i];
        printf("%s{\"rms\": ", i ? ", " : "");
        json_number(stdout, sqrt(ratio(s->square, (double)s->pixels)));
        printf(", \"psnr_db\": ");
        json_number(stdout, ratio(s->psnr, (double)s->images));
        putchar('}');
    }
    puts("]}");
}

static void print_text(const struct evaluation *e)
{
    const double images = (double)e->images;
    printf("images    %zu (%d views x %d lights)\n", e->images, e->manifest->views,
           e->manifest->lights);
    printf("PSNR      %.2f dB (mean over images)\n", ratio(e->psnr, images));
    printf("SSIM      %.4f\n", ratio(e->ssim, (double)e->structured));
    printf("deltaE    %.3f (CIEDE2000)\n", ratio(e->delta_e, images));
    printf("RMS       %.5f (linear)\n", sqrt(ratio(e->square, (double)e->pixels)));
    printf("file      %llu bytes, %.3f bits per pixel and view\n",
           (unsigned long long)e->info->file_bytes,
           8.0 * (double)e->info->file_bytes /
               ((double)e->info->views * e->info->width * e->info->height));
}

static relume_status evaluate(struct evaluation *e)
{
    relume_status status = check_fit(e, args_input(e->args, 1));
    if (status)
        return status;
    e->light = calloc((size_t)e->manifest->lights, sizeof *e->light);
    if (!e->light)
        return RELUME_ENOMEM;
    if (e->manifest->transfer.curve == RELUME_CURVE_GAMMA)
        e->display = e->manifest->transfer;
    for (int view = 0; !status && view < e->manifest->views; view++)
        status = evaluate_view(e, view);
    if (!status)
        (args_has(e->args, "--json") ? print_json : print_text)(e);
    free(e->light);
    return status;
}

static relume_status run(const struct args *args)
{
    struct relume_transfer transfer = {RELUME_CURVE_AUTO, 0.0f};
    const char *text = args_text(args, "--transfer", NULL);
    if (text && relume_transfer_parse(&transfer, text))
        return usage_error("--transfer: expected linear, srgb or gamma:G; found '%s'", text);
    struct evaluation e = {.args = args};
    relume_status status =
        relume_pack_open(&e.pack, args_input(args, 0),
                         relume_pack_params(.log = args_log(args), .threads = args_threads(args)));
    if (!status)
        status = relume_capture_open(
            &e.capture, args_input(args, 1),
            relume_capture_params(.log = args_log(args), .transfer = transfer,
                                  .skip_missing = args_has(args, "--skip-missing")));
    if (!status) {
        e.info = relume_pack_info(e.pack);
        e.manifest = relume_capture_manifest(e.capture);
        status = evaluate(&e);
    }
    relume_capture_destroy(&e.capture);
    relume_pack_destroy(&e.pack);
    return status;
}

const struct command command_eval = {
    .name = "eval",
    .usage = "FILE CAPTURE [--json]",
    .summary = "relight with every light of a capture and compare with its images",
    .example = "relume eval statue.exr photos/heldout.lp --json",
    .min_inputs = 2,
    .max_inputs = 2,
    .options = options,
    .run = run,
};
