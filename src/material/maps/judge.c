// judge.c - maps against photographs
#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/image/encoder.h"
#include "material/maps/maps.h"

#include <string.h>

struct judging {
    const struct relume_maps *maps;
    const struct relume_image *mask;  // or empty
    struct encoder *display;
    float *square;  // [pixels]: of display errors, over lights
    size_t shadowed, brighter, samples;
};

static void add_differences(struct judging *j, const struct relume_image *maps,
                            const struct relume_image *photo)
{
    const size_t pixels = (size_t)maps->width * (size_t)maps->height;
    for (size_t i = 0; i < pixels; i++) {
        float a[3], b[3], mean = 0.0f;
        if (j->mask->data && !(j->mask->data[i] > 0.5f))
            continue;
        encoder_apply(j->display, maps->data + 3 * i, a, 3);
        encoder_apply(j->display, photo->data + 3 * i, b, 3);
        for (int c = 0; c < 3; c++) {
            const float d = encoder_clip(a[c]) - encoder_clip(b[c]);
            mean += d / 3.0f;
            j->square[i] += d * d / 3.0f;
        }
        j->shadowed += mean > (float)RELUME_MAPS_OFF;
        j->brighter += mean < -(float)RELUME_MAPS_OFF;
        j->samples++;
    }
}

// Windows of SSIM reach across the mask's edge, where maps show nothing.
static void fill_outside(const struct judging *j, struct relume_image *maps,
                         const struct relume_image *photo)
{
    const size_t pixels = (size_t)maps->width * (size_t)maps->height;
    for (size_t i = 0; j->mask->data && i < pixels; i++)
        if (!(j->mask->data[i] > 0.5f))
            memcpy(maps->data + 3 * i, photo->data + 3 * i, 3 * sizeof *maps->data);
}

static void finish(struct relume_maps_quality *out, const struct judging *j)
{
    const size_t pixels = (size_t)j->maps->width * (size_t)j->maps->height;
    const double limit = RELUME_MAPS_OFF * RELUME_MAPS_OFF * out->lights;
    size_t off = 0, known = 0;
    for (size_t i = 0; i < pixels; i++) {
        const bool seen = !j->mask->data || j->mask->data[i] > 0.5f;
        known += seen;
        off += seen && (double)j->square[i] > limit;
    }
    out->psnr_db /= out->lights;
    out->ssim /= out->lights;
    out->delta_e /= out->lights;
    out->off = known ? (double)off / (double)known : NAN;
    out->shadowed = j->samples ? (double)j->shadowed / (double)j->samples : NAN;
    out->brighter = j->samples ? (double)j->brighter / (double)j->samples : NAN;
}

static relume_status judge_light(struct relume_maps_quality *out, struct judging *j,
                                 const relume_capture *capture, int view,
                                 const struct maps_light *light, int threads,
                                 const struct relume_log *log)
{
    struct relume_image photo = {0}, relit = {0};
    struct relume_difference d;
    relume_status status = relume_capture_image(&photo, capture, view, light->light, log);
    if (!status)
        status = maps_relight(&relit, j->maps, light, threads);
    if (!status) {
        fill_outside(j, &relit, &photo);
        status = relume_image_compare(
            &d, &relit, &photo,
            relume_compare_params(.mask = j->mask->data ? j->mask : NULL, .threads = threads));
    }
    if (!status) {
        add_differences(j, &relit, &photo);
        out->psnr_db += d.psnr_db;
        out->ssim += d.ssim;
        out->delta_e += d.delta_e;
    }
    relume_image_destroy(&photo);
    relume_image_destroy(&relit);
    return status;
}

relume_status maps_judge(struct relume_maps_quality *out, const struct relume_maps *maps,
                         const relume_capture *capture, int view, const int *light, int lights,
                         int threads, const struct relume_log *log)
{
    const size_t pixels = (size_t)maps->width * (size_t)maps->height;
    const struct relume_vec3 *directions = relume_capture_manifest(capture)->directions;
    struct near_view near = {0};
    struct relume_image mask = {0};
    struct judging j = {
        .maps = maps,
        .mask = &mask,
        .display = mem_array(1, sizeof *j.display),
        .square = mem_zeroed(pixels, sizeof *j.square),
    };
    *out = (struct relume_maps_quality){.lights = lights};
    const bool is_near = near_view_applies(capture, view);
    relume_status status = j.display && j.square ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = relume_capture_mask(&mask, capture, view, log);
    if (!status && is_near)
        status = near_view_open(&near, capture, view, log);
    if (!status)
        encoder_init(j.display, (struct relume_transfer){.curve = RELUME_CURVE_SRGB});
    for (int i = 0; !status && i < lights; i++) {
        const struct maps_light at = {is_near ? &near : NULL, light[i], directions[light[i]]};
        status = judge_light(out, &j, capture, view, &at, threads, log);
        if (!status && !log_progress(log, "judging", (i + 1.0) / lights))
            status = RELUME_ECANCEL;
    }
    if (!status)
        finish(out, &j);
    mem_free(j.display);
    mem_free(j.square);
    near_view_close(&near);
    relume_image_destroy(&mask);
    return status;
}
