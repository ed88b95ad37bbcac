// evaluate.c - a file relit with every light of a capture and compared with every image
#include <relume/evaluate.h>
#include <relume/image/jnd.h>
#include <relume/renderer.h>

#include "core/base/context.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "core/math/vec.h"
#include "format/coder/coding.h"

#include <math.h>
#include <stdio.h>

// Sums over the images of one light, or of all.
struct sums {
    double square, mse;  // x pixels
    double psnr, ssim, delta_e, jnd, jnd_worst;
    size_t pixels, images, structured;
};

// Sentences about the file begin with its name. While lights are shown one by one, what the
// renderer would warn of each is left out: warn_beyond has said it of all.
struct about {
    struct relume_log log;
    const struct relume_log *to;
    const char *name;
    bool drawing;
};

struct evaluator {
    struct relume_evaluate_params params;
    relume_pack *pack;
    const relume_capture *capture;
    const struct relume_manifest *manifest;
    const struct relume_pack_info *info;
    struct relume_transfer display;
    relume_renderer *renderer;
    struct about about;
    struct relume_image relit;
    struct sums *light;  // [lights]
    struct sums total;
    // captured images are read ahead, as many at once as there are threads
    int view, first, ahead;
    struct relume_image *image;  // [ahead]
    relume_status *status;       // [ahead]
};

static void say_about(void *user, enum relume_level level, const char *text)
{
    const struct about *a = user;
    if (!(a->drawing && level == RELUME_WARNING))
        log_line(a->to, level, "%s: %s", a->name, text);
}

static bool forward_progress(void *user, const char *what, double done)
{
    const struct about *a = user;
    return log_progress(a->to, what, done);
}

void relume_evaluation_destroy(struct relume_evaluation *evaluation)
{
    mem_free(evaluation->light);
    *evaluation = (struct relume_evaluation){0};
}

// The stored view that stands where a captured one does, -1 when there is none.
static int matching_view(const struct evaluator *e, int view)
{
    if (e->info->geometry.projection != RELUME_SLAB)
        return view < e->info->views ? view : -1;
    const struct relume_manifest_view *v = &e->manifest->view[view];
    const double *uv = v->uv;
    for (int i = 0; i < e->info->views; i++)
        if ((!e->info->slabs || e->info->slab_of[i] == v->slab) &&
            fabs(e->info->uv[i][0] - uv[0]) <= 1e-6 && fabs(e->info->uv[i][1] - uv[1]) <= 1e-6)
            return i;
    return -1;
}

static struct relume_camera camera_for(const struct evaluator *e, int view)
{
    const int match = matching_view(e, view);
    if (match >= 0)
        return (struct relume_camera){.framing = RELUME_FRAME_VIEW, .view = match};
    const struct relume_manifest *m = e->manifest;
    const struct relume_manifest_view *v = &m->view[view];
    const struct relume_geometry *g = m->slabs ? &m->slab[v->slab] : &m->geometry;
    const struct relume_vec3 eye = {v->uv[0], v->uv[1], g->uv_z};
    return (struct relume_camera){.framing = RELUME_FRAME_EYE,
                                  .eye = relume_pose_world(&g->pose, eye),
                                  .through = m->slabs ? v->slab + 1 : 0};
}

static bool same(double a, double b)
{
    return fabs(a - b) <= 1e-4 * (1.0 + fabs(a));
}

static bool same_place(const struct relume_pose *p, const struct relume_pose *q,
                       struct relume_vec3 local)
{
    const struct relume_vec3 a = relume_pose_world(p, local), b = relume_pose_world(q, local);
    return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}

// The planes and windows of two slabs lie in the same place; files keep them in single precision.
static bool same_slab(const struct relume_geometry *a, const struct relume_geometry *b)
{
    const struct relume_vec3 corner[] = {
        {a->st_min[0], a->st_min[1], a->st_z},
        {a->st_max[0], a->st_min[1], a->st_z},
        {a->st_min[0], a->st_max[1], a->st_z},
        {0.0, 0.0, a->uv_z},
    };
    for (int i = 0; i < 4; i++)
        if (!same_place(&a->pose, &b->pose, corner[i]))
            return false;
    return same(a->uv_z, b->uv_z) && same(a->st_z, b->st_z) && same(a->st_min[0], b->st_min[0]) &&
           same(a->st_min[1], b->st_min[1]) && same(a->st_max[0], b->st_max[0]) &&
           same(a->st_max[1], b->st_max[1]);
}

static relume_status check_slabs(const struct evaluator *e)
{
    const struct relume_manifest *m = e->manifest;
    if (m->slabs != e->info->slabs)
        return log_fail(e->params.log, RELUME_EUNFIT, "%s: %d slabs; expected %d as in the file",
                        e->params.capture, m->slabs ? m->slabs : 1,
                        e->info->slabs ? e->info->slabs : 1);
    for (int i = 0; i < m->slabs; i++)
        if (!same_slab(&m->slab[i], &e->info->slab[i]))
            return log_fail(e->params.log, RELUME_EUNFIT,
                            "%s: slab %d is at another place than in the file; expected the same "
                            "planes and pose",
                            e->params.capture, i);
    return RELUME_OK;
}

static void add(struct sums *s, const struct relume_difference *d)
{
    if (d->pixels == 0)
        return;
    s->square += d->rms * d->rms * (double)d->pixels;
    s->mse += d->mse * (double)d->pixels;
    s->psnr += d->psnr_db;
    s->delta_e += d->delta_e;
    s->pixels += d->pixels;
    s->images++;
    if (isfinite(d->ssim)) {
        s->ssim += d->ssim;
        s->structured++;
    }
}

// ---------------------------------------------------------------- one view

static void load_image(void *context, size_t item, int worker)
{
    (void)worker;
    struct evaluator *e = context;
    e->status[item] = relume_capture_image(&e->image[item], e->capture, e->view,
                                           e->first + (int)item * e->params.every, NULL);
}

// A broken image is read again by the caller's thread, which may say why.
static relume_status load_ahead(struct evaluator *e, int count)
{
    thread_for(e->params.threads, (size_t)count, load_image, e);
    for (int i = 0; i < count; i++) {
        relume_status status = e->status[i];
        if (relume_status_is_input(status))
            status = relume_capture_image(&e->image[i], e->capture, e->view,
                                          e->first + i * e->params.every, e->params.log);
        if (status)
            return status;
    }
    return RELUME_OK;
}

// Lamps a little below the horizon of a hemispherical capture count as on it, when it is encoded
// and here: no warning is due.
static vec3 photographed_from(const struct evaluator *e, int light)
{
    const struct relume_coder_info *info = relume_coder_info(e->info->coder);
    vec3 d = pole_from_world(e->manifest->directions[light], info->pole_y);
    if (info->hemispherical && relume_capture_hemispherical(e->capture))
        d.z = fmax(d.z, 0.0);
    return world_from_pole(d, info->pole_y);
}

static void warn_beyond(const struct evaluator *e)
{
    static const double little = 3.0;  // degrees that nobody sees
    double most = 0.0;
    int beyond = 0;
    for (int i = 0; i < e->manifest->lights; i++) {
        const vec3 d = vec3_unit(photographed_from(e, i));
        vec3 from;
        (void)relume_coder_clamp(&from, e->info->coder, d);
        const double off = vec3_angle(from, d) * (180.0 / M_PI);
        beyond += off > little;
        most = fmax(off, most);
    }
    if (beyond)
        log_line(
            &e->about.log, RELUME_WARNING,
            "%d of %d light%s %s outside the directions that were photographed for it, by up to "
            "%.0f degrees; shown from the nearest of them, dimmed",
            beyond, e->manifest->lights, relume_plural(e->manifest->lights),
            beyond == 1 ? "lies" : "lie", most);
}

// Mean and worst of the images that have something to compare.
static relume_status see(struct evaluator *e, const struct relume_image *captured,
                         const struct relume_image *mask)
{
    struct relume_jnd seen;
    const relume_status status = relume_image_jnd(
        &seen, NULL, &e->relit, captured,
        relume_jnd_params(.threads = e->params.threads, .mask = mask->data ? mask : NULL));
    if (!status) {
        e->total.jnd += seen.most;
        e->total.jnd_worst = fmax(e->total.jnd_worst, seen.most);
    }
    return status;
}

static relume_status compare_light(struct evaluator *e, const struct relume_image *captured,
                                   int light, const struct relume_camera *camera,
                                   const struct relume_image *mask)
{
    struct relume_light lamp = {.direction = photographed_from(e, light),
                                .rgb = {1.0f, 1.0f, 1.0f}};
    if (e->manifest->positions) {
        lamp.kind = RELUME_LIGHT_POINT;
        lamp.nofall = true;
        lamp.position = e->manifest->positions[light];
    }
    const struct relume_target target = {
        .data = e->relit.data, .width = e->relit.width, .height = e->relit.height};
    struct relume_difference difference = {.pixels = 0};
    relume_status status = relume_renderer_set_lights(e->renderer, &lamp, 1);
    if (!status)
        status = relume_renderer_draw(e->renderer, camera, &target);
    if (!status)
        status = relume_image_compare(&difference, &e->relit, captured,
                                      relume_compare_params(.mask = mask, .display = e->display,
                                                            .threads = e->params.threads,
                                                            .no_ssim = e->params.no_ssim,
                                                            .no_delta_e = e->params.no_delta_e));
    if (status)
        return status;
    add(&e->light[light], &difference);
    add(&e->total, &difference);
    return e->params.jnd && difference.pixels ? see(e, captured, mask) : RELUME_OK;
}

static relume_status evaluate_some(struct evaluator *e, const struct relume_camera *camera,
                                   const struct relume_image *mask)
{
    const int every = e->params.every, left = (e->manifest->lights - e->first + every - 1) / every,
              count = left < e->ahead ? left : e->ahead;
    relume_status status = load_ahead(e, count);
    for (int i = 0; !status && i < count; i++) {
        const int light = e->first + i * every;
        status = compare_light(e, &e->image[i], light, camera, mask);
        const double done = (e->view + (light + 1.0) / e->manifest->lights) / e->manifest->views;
        if (!status && !log_progress(e->params.log, "evaluating", done))
            status = RELUME_ECANCEL;
    }
    for (int i = 0; i < e->ahead; i++)
        relume_image_destroy(&e->image[i]);
    e->first += count * every;
    return status;
}

static relume_status evaluate_view(struct evaluator *e, int view)
{
    const struct relume_camera camera = camera_for(e, view);
    struct relume_image mask;
    relume_status status = relume_capture_mask(&mask, e->capture, view, e->params.log);
    e->view = view;
    // one image of so many goes on from view to view
    const long long before = (long long)view * e->manifest->lights;
    e->first = (int)((e->params.every - before % e->params.every) % e->params.every);
    while (!status && e->first < e->manifest->lights)
        status = evaluate_some(e, &camera, &mask);
    if (camera.framing == RELUME_FRAME_VIEW)
        relume_renderer_forget(e->renderer);
    relume_image_destroy(&mask);
    return status;
}

// ---------------------------------------------------------------- the whole

static relume_status check_fit(const struct evaluator *e)
{
    const int width = relume_capture_width(e->capture), height = relume_capture_height(e->capture);
    const enum relume_projection theirs = e->manifest->geometry.projection;
    const enum relume_projection ours = e->info->geometry.projection;
    const struct relume_log *log = e->params.log;
    const char *name = e->params.capture;
    if (width != e->info->width || height != e->info->height)
        return log_fail(log, RELUME_EUNFIT, "%s: %d x %d pixels; expected %d x %d as in the file",
                        name, width, height, e->info->width, e->info->height);
    if (theirs != ours)
        return log_fail(log, RELUME_EUNFIT, "%s: a %s capture; expected %s as in the file", name,
                        relume_projection_name(theirs), relume_projection_name(ours));
    if (ours != RELUME_SLAB && e->manifest->views > e->info->views)
        return log_fail(log, RELUME_EUNFIT, "%s: %d views; expected at most %d as in the file",
                        name, e->manifest->views, e->info->views);
    return ours == RELUME_SLAB ? check_slabs(e) : RELUME_OK;
}

static double ratio(double a, double b)
{
    return b > 0.0 ? a / b : (double)NAN;
}

static double decibel(double mse)
{
    return mse >= 0.0 ? decibels(mse) : mse;
}

static void collect(const struct evaluator *e, struct relume_evaluation *out)
{
    const struct sums *t = &e->total;
    const double pixels = (double)e->info->width * e->info->height;
    out->views = e->manifest->views;
    out->lights = e->manifest->lights;
    out->width = e->info->width;
    out->height = e->info->height;
    out->images = t->images;
    out->rms = sqrt(ratio(t->square, (double)t->pixels));
    out->psnr_db = ratio(t->psnr, (double)t->images);
    out->psnr_pooled_db = decibel(ratio(t->mse, (double)t->pixels));
    out->ssim = ratio(t->ssim, (double)t->structured);
    out->delta_e = ratio(t->delta_e, (double)t->images);
    out->jnd = e->params.jnd ? ratio(t->jnd, (double)t->images) : (double)NAN;
    out->jnd_worst = e->params.jnd && t->images ? t->jnd_worst : (double)NAN;
    out->file_bytes = (double)e->info->file_bytes;
    out->raw_bytes = (double)out->views * out->lights * pixels * 12.0;
    out->ratio = out->raw_bytes / out->file_bytes;
    out->bits_per_pixel = 8.0 * out->file_bytes / (e->info->views * pixels);
    for (int i = 0; i < out->lights; i++) {
        const struct sums *s = &e->light[i];
        out->light[i].rms = sqrt(ratio(s->square, (double)s->pixels));
        out->light[i].psnr_db = ratio(s->psnr, (double)s->images);
    }
}

static relume_status make_renderer(struct evaluator *e)
{
    e->about = (struct about){.to = e->params.log, .name = e->params.file};
    e->about.log = (struct relume_log){say_about, forward_progress, &e->about,
                                       context_of(e->params.log), false};
    const relume_status status = relume_image_create(&e->relit, e->info->width, e->info->height, 3);
    return status ? status
                  : relume_renderer_create(
                        &e->renderer, e->pack,
                        relume_frame_params(.log = &e->about.log, .threads = e->params.threads));
}

static bool create(struct evaluator *e, struct relume_evaluation *out)
{
    const size_t lights = (size_t)e->manifest->lights;
    e->ahead = thread_count(e->params.threads);
    if (e->ahead > e->manifest->lights)
        e->ahead = e->manifest->lights;
    e->light = mem_zeroed(lights, sizeof *e->light);
    e->image = mem_zeroed((size_t)e->ahead, sizeof *e->image);
    e->status = mem_zeroed((size_t)e->ahead, sizeof *e->status);
    out->light = mem_zeroed(lights, sizeof *out->light);
    return e->light && e->image && e->status && out->light;
}

relume_status relume_evaluate(struct relume_evaluation *out, relume_pack *pack,
                              const relume_capture *capture,
                              const struct relume_evaluate_params *params)
{
    struct evaluator e = {
        .params = PARAMS_WORK(relume_evaluate_params, params),
        .pack = pack,
        .capture = capture,
        .manifest = relume_capture_manifest(capture),
        .info = relume_pack_info(pack),
    };
    *out = (struct relume_evaluation){0};
    e.params.file = e.params.file ? e.params.file : "the file";
    e.params.capture = e.params.capture ? e.params.capture : "the capture";
    e.params.every = e.params.every > 1 ? e.params.every : 1;
    relume_status status = check_fit(&e);
    if (status)
        return status;
    if (e.manifest->transfer.curve == RELUME_CURVE_GAMMA)
        e.display = e.manifest->transfer;
    status = create(&e, out) ? make_renderer(&e) : RELUME_ENOMEM;
    if (!status && !e.manifest->positions)
        warn_beyond(&e);
    e.about.drawing = true;
    for (int view = 0; !status && view < e.manifest->views; view++)
        status = evaluate_view(&e, view);
    if (!status)
        collect(&e, out);
    else
        relume_evaluation_destroy(out);
    relume_renderer_destroy(&e.renderer);
    relume_image_destroy(&e.relit);
    mem_free(e.light);
    mem_free(e.image);
    mem_free(e.status);
    return status;
}
