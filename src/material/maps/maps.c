// maps.c - from photographs to maps: the shape, the codebook, each pixel's place in it, its colour
#include "material/maps/maps.h"

#include "capture/acquire/photometric.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/sort.h"
#include "material/maps/materials.h"

#include <relume/capture/photometric.h>
#include <stdio.h>
#include <string.h>

enum { LEARNERS = 600, MOST_JUDGED = 16, EVERY = 8, DEFAULT_MATERIALS = 8, REACH = 3, TURNS = 3 };
static const float GUIDE = 0.08f;  // coded difference of colours across which losses mix a third
static const double BLEND = 0.1;   // of the least loss: so much more counts a third
// Photographs are not of a light of value 1 when most pixels, seen as matte, reflect more than
// that, or the brightest hardly anything; then the brightest become this. Highlights and metals
// are too bright for matte surfaces: they are no evidence unless they are most of the picture.
static const double BRIGHTEST = 0.8, TOO_BRIGHT = 1.0, TOO_DARK = 0.03;

struct maps_fitting {
    struct relume_maps_params params;
    struct relume_maps *out;
    const relume_capture *capture;
    int *light;  // [all]: first those that are fitted, then those held out
    int fitted, held;
    struct relume_photometric shape;
    struct relume_image sure;  // how sure its normals are, of which the heights are made
    struct photos photos;
    struct learner *learner;  // [LEARNERS]
    float *memory;            // of their looks
    size_t learners;
    int step;  // every step-th pixel of every step-th row learns
    struct materials materials;
    struct relume_image loss[RELUME_MAPS_MOST_MATERIALS];
    struct relume_image f0;
};

static size_t pixels_of(const struct maps_fitting *w)
{
    return (size_t)w->photos.width * (size_t)w->photos.height;
}

static bool is_known(const struct maps_fitting *w, size_t at)
{
    return w->photos.known.data[at] > 0.5f;
}

// ---------------------------------------------------------------- what is asked

// Most is held when heights are integrated: measured (a million pixels: 204 MB, of which 36 are the
// program and photographs in work). Losses of 16 materials take less.
static relume_status check_memory(const struct maps_fitting *w)
{
    enum { BYTES = 170 };  // a pixel
    const uint64_t pixels = (uint64_t)w->out->width * (uint64_t)w->out->height;
    return limits_memory(NULL, pixels * BYTES, "what is known of a picture of this size",
                         w->params.log);
}

static relume_status check(const struct maps_fitting *w)
{
    const struct relume_manifest *m = relume_capture_manifest(w->capture);
    const struct relume_maps_params *p = &w->params;
    if (m->geometry.projection >= RELUME_CYLINDRICAL)
        return log_fail(p->log, RELUME_EUNSUPPORTED,
                        "maps lie on a plane: expected a planar capture or a slab; found a "
                        "panorama (its normals: relume relight --pass normals)");
    if (m->slabs)
        return log_fail(p->log, RELUME_EUNSUPPORTED,
                        "maps lie on a plane: expected a planar capture or one slab; found %d "
                        "slabs around an object",
                        m->slabs);
    if (p->view < 0 || p->view >= m->views)
        return log_fail(p->log, RELUME_EINVAL, "view %d does not exist; expected 0 to %d", p->view,
                        m->views - 1);
    if (p->materials < 0 || p->materials > RELUME_MAPS_MOST_MATERIALS || p->held_out < -1 ||
        p->gain < 0.0 || !isfinite(p->gain))
        return log_fail(p->log, RELUME_EINVAL,
                        "expected 1 to %d materials, no lights held out or some, and a gain above "
                        "0",
                        RELUME_MAPS_MOST_MATERIALS);
    if (m->lights < 3)
        return log_fail(p->log, RELUME_EUNFIT,
                        "maps need at least 3 lights, and %d for roughness and highlights; found "
                        "%d",
                        RELUME_MAPS_LEAST_LIGHTS, m->lights);
    if (p->held_out > 0 && m->lights - p->held_out < RELUME_MAPS_LEAST_LIGHTS - 2)
        return log_fail(
            p->log, RELUME_EINVAL,
            "%d of %d lights cannot be held out; expected at most %d: at least %d are "
            "needed for the fit",
            p->held_out, m->lights,
            m->lights > RELUME_MAPS_LEAST_LIGHTS - 2 ? m->lights - RELUME_MAPS_LEAST_LIGHTS + 2 : 0,
            RELUME_MAPS_LEAST_LIGHTS - 2);
    return check_memory(w);
}

// Those held out lie evenly in the order of the capture, which mostly follows the dome.
static relume_status divide_lights(struct maps_fitting *w)
{
    const int all = relume_capture_manifest(w->capture)->lights;
    const int asked = w->params.held_out;
    w->out->matte_only = all < RELUME_MAPS_LEAST_LIGHTS;
    w->held = asked > 0                         ? asked
              : asked < 0 || w->out->matte_only ? 0
              : (all + EVERY / 2) / EVERY > 2   ? (all + EVERY / 2) / EVERY
                                                : 2;
    w->fitted = all - w->held;
    w->light = mem_array((size_t)all, sizeof *w->light);
    if (!w->light)
        return RELUME_ENOMEM;
    int fitted = 0, held = 0;
    for (int i = 0; i < all; i++)
        if (held < w->held && i == (int)((held + 0.5) * all / w->held))
            w->light[w->fitted + held++] = i;
        else
            w->light[fitted++] = i;
    w->out->lights = w->fitted;
    return RELUME_OK;
}

// ---------------------------------------------------------------- shape and brightness

static relume_status find_shape(struct maps_fitting *w)
{
    relume_capture *some;
    relume_status status = relume_capture_select(&some, w->capture, w->light, w->fitted);
    if (!status)
        status = relume_photometric_fit(&w->shape, some, w->params.view,
                                        relume_photometric_params(.log = w->params.log,
                                                                  .threads = w->params.threads,
                                                                  .plain = w->params.gloss_alone));
    relume_capture_destroy(&some);
    return status;
}

// Pixels without a normal are not known from here on.
static relume_status find_known(struct maps_fitting *w)
{
    size_t known = 0;
    for (size_t i = 0; i < pixels_of(w); i++) {
        const float *n = w->shape.normal.data + 3 * i;
        if (n[0] == 0.0f && n[1] == 0.0f && n[2] == 0.0f)
            w->photos.known.data[i] = 0.0f;
        known += is_known(w, i);
    }
    if (known)
        return RELUME_OK;
    return log_fail(w->params.log, RELUME_EUNFIT,
                    "nothing to make maps of: %s; expected a surface that some lights reach",
                    relume_capture_manifest(w->capture)->view[w->params.view].mask
                        ? "the mask is empty, or all that it shows is black"
                        : "the photographs are black");
}

static relume_status find_gain(struct maps_fitting *w)
{
    size_t n = 0;
    float *most = mem_array(pixels_of(w), sizeof *most);
    if (!most)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < pixels_of(w); i++) {
        const float *a = w->shape.albedo.data + 3 * i;
        if (is_known(w, i))
            most[n++] = fmaxf(fmaxf(a[0], a[1]), a[2]);
    }
    sort_floats(most, n);
    const double brightest = (double)most[n - 1 - n / 50], usual = (double)most[n / 2];
    mem_free(most);
    w->out->gain = w->params.gain > 0.0 ? w->params.gain
                   : usual > TOO_BRIGHT || (brightest < TOO_DARK && brightest > 0.0)
                       ? BRIGHTEST / brightest
                       : 1.0;
    w->photos.gain = (float)w->out->gain;
    for (size_t i = 0; i < 3 * pixels_of(w); i++)
        w->shape.albedo.data[i] = fminf(w->shape.albedo.data[i] * w->photos.gain, 1.0f);
    return RELUME_OK;
}

// ---------------------------------------------------------------- the codebook

static relume_status prepare_learners(struct maps_fitting *w)
{
    size_t known = 0;
    for (size_t i = 0; i < pixels_of(w); i++)
        known += is_known(w, i);
    w->step = (int)ceil(sqrt((double)known / LEARNERS));
    for (size_t i = 0; i < pixels_of(w); i++) {
        const size_t x = i % (size_t)w->photos.width, y = i / (size_t)w->photos.width;
        w->learners += is_known(w, i) && x % (size_t)w->step == 0 && y % (size_t)w->step == 0;
    }
    w->learner = mem_zeroed(w->learners, sizeof *w->learner);
    w->memory = mem_array(w->learners * look_size(w->fitted), sizeof *w->memory);
    return w->learner && w->memory ? RELUME_OK : RELUME_ENOMEM;
}

// Learners stand in the order of their pixels.
static void gather_row(void *context, size_t y, int worker)
{
    (void)worker;
    const struct maps_fitting *w = context;
    const size_t width = (size_t)w->photos.width, step = (size_t)w->step;
    size_t at = 0;
    if (y % step)
        return;
    for (size_t row = 0; row < y; row += step)
        for (size_t x = 0; x < width; x += step)
            at += is_known(w, row * width + x);
    for (size_t x = 0; x < width; x += step) {
        const size_t pixel = y * width + x;
        if (!is_known(w, pixel))
            continue;
        struct learner *l = &w->learner[at];
        photos_look_into(&l->look, &w->photos, (int)x, (int)y,
                         w->memory + at++ * look_size(w->fitted));
        memcpy(l->matte, w->shape.normal.data + 3 * pixel, sizeof l->matte);
        memcpy(l->albedo, w->shape.albedo.data + 3 * pixel, sizeof l->albedo);
    }
}

static relume_status find_materials(struct maps_fitting *w)
{
    relume_status status = prepare_learners(w);
    if (!status)
        status = photos_each(&w->photos, "materials", gather_row, w);
    if (!status)
        status = materials_learn(&w->materials, w->learner, w->learners,
                                 w->params.materials ? w->params.materials : DEFAULT_MATERIALS,
                                 w->out->matte_only, w->photos.threads);
    mem_free(w->memory);
    mem_free(w->learner);
    w->memory = NULL;
    w->learner = NULL;
    return status;
}

// ---------------------------------------------------------------- each pixel's place in it

// The normal and colour of a pixel of that gloss; returns its loss.
static float fit_pixel(float normal[3], float colour[3], const struct maps_fitting *w,
                       const struct look *k, const struct gloss *g, size_t at)
{
    float start[3];
    gloss_start(start, k, g, w->shape.normal.data + 3 * at);
    memcpy(normal, start, sizeof start);
    const float loss = gloss_try(colour, k, g, normal, w->shape.albedo.data + 3 * at);
    const bool kept = w->params.keep_normals || w->out->matte_only;
    return kept ? loss : gloss_straighten(normal, colour, k, g, start, TURNS);
}

// Losses are found of every such column and row.
static int every_of(const struct maps_fitting *w)
{
    return w->params.gloss_alone ? 2 : 1;
}

static void lose_row(void *context, size_t y, int worker)
{
    const struct maps_fitting *w = context;
    const size_t width = (size_t)w->photos.width;
    struct look k;
    const size_t every = (size_t)every_of(w);
    for (size_t x = 0; y % every == 0 && x < width; x += every) {
        const size_t at = y * width + x;
        if (!is_known(w, at))
            continue;
        photos_look(&k, &w->photos, (int)x, (int)y, worker);
        for (int i = 0; i < w->materials.count; i++) {
            const struct gloss *g = &w->materials.gloss[i];
            float normal[3], colour[3];
            w->loss[i].data[at] = fit_pixel(normal, colour, w, &k, g, at);
        }
    }
}

// The loss of every material, meaned over neighbours of like colour.
static void mean_losses(double loss[], const struct maps_fitting *w, int x, int y)
{
    const int width = w->photos.width, height = w->photos.height, every = every_of(w);
    const float *here = w->shape.albedo.data + 3 * ((size_t)y * (size_t)width + (size_t)x);
    double sum = 0.0;
    memset(loss, 0, (size_t)w->materials.count * sizeof *loss);
    for (int v = y - REACH; v <= y + REACH; v++)
        for (int u = x - REACH; u <= x + REACH; u++) {
            const size_t at = (size_t)v * (size_t)width + (size_t)u;
            if (u < 0 || v < 0 || u >= width || v >= height || u % every || v % every ||
                !is_known(w, at))
                continue;
            float far = 0.0f;
            for (int c = 0; c < 3; c++) {
                const float d =
                    code_of(w->shape.albedo.data[3 * at + (size_t)c]) - code_of(here[c]);
                far += d * d;
            }
            const double weight = 1.0 / (1.0 + (double)(far / (GUIDE * GUIDE)));
            sum += weight;
            for (int i = 0; i < w->materials.count; i++)
                loss[i] += weight * (double)w->loss[i].data[at];
        }
    for (int i = 0; sum > 0.0 && i < w->materials.count; i++)
        loss[i] /= sum;
}

static void place_pixel(const struct maps_fitting *w, int x, int y)
{
    const struct materials *m = &w->materials;
    const size_t at = (size_t)y * (size_t)w->photos.width + (size_t)x;
    double loss[RELUME_MAPS_MOST_MATERIALS], sum = 0.0, roughness = 0.0, f0 = 0.0;
    int best = 0;
    mean_losses(loss, w, x, y);
    for (int i = 1; i < m->count; i++)
        best = loss[i] < loss[best] ? i : best;
    for (int i = 0; i < m->count; i++) {
        const double weight = m->gloss[i].metal == m->gloss[best].metal
                                  ? exp((loss[best] - loss[i]) / (BLEND * loss[best] + 1e-9))
                                  : 0.0;
        sum += weight;
        roughness += weight * (double)m->gloss[i].roughness;
        f0 += weight * (double)m->gloss[i].f0;
    }
    w->out->roughness.data[at] = (float)(roughness / sum);
    w->out->metallic.data[at] = m->gloss[best].metal ? 1.0f : 0.0f;
    w->f0.data[at] = (float)(f0 / sum);
}

static void place_row(void *context, size_t y, int worker)
{
    (void)worker;
    const struct maps_fitting *w = context;
    for (int x = 0; x < w->photos.width; x++)
        if (is_known(w, y * (size_t)w->photos.width + (size_t)x))
            place_pixel(w, x, (int)y);
}

static relume_status find_places(struct maps_fitting *w)
{
    relume_status status = relume_image_create(&w->f0, w->photos.width, w->photos.height, 1);
    for (int i = 0; !status && i < w->materials.count; i++)
        status = relume_image_create(&w->loss[i], w->photos.width, w->photos.height, 1);
    if (!status && w->materials.count > 1)
        status = photos_each(&w->photos, "gloss", lose_row, w);
    if (!status)
        thread_for(w->photos.threads, (size_t)w->photos.height, place_row, w);
    for (int i = 0; i < RELUME_MAPS_MOST_MATERIALS; i++)
        relume_image_destroy(&w->loss[i]);
    return status;
}

// ---------------------------------------------------------------- colour and confidence

static float share_explained(const struct look *k, const float colour[3])
{
    int good = 0;
    for (int i = 0; i < k->known; i++) {
        float most = 0.0f;
        for (int c = 0; c < 3; c++) {
            const float d = code_of(k->base[i] + colour[c] * k->slope[i]) - k->coded[c][i];
            most = fmaxf(most, k->clipped[i] != 0.0f && d > 0.0f ? 0.0f : fabsf(d));
        }
        good += most < (float)RELUME_MAPS_OFF;
    }
    return (float)good / (float)k->known;
}

static void colour_pixel(const struct maps_fitting *w, const struct look *k, size_t at)
{
    struct relume_maps *out = w->out;
    const struct gloss g = {out->metallic.data[at] > 0.5f, w->f0.data[at], out->roughness.data[at]};
    float *colour = out->base_color.data + 3 * at;
    fit_pixel(out->normal.data + 3 * at, colour, w, k, &g, at);
    for (size_t c = 0; c < 3; c++)
        out->specular.data[3 * at + c] = g.metal ? colour[c] : g.f0;
    out->confidence.data[at] = share_explained(k, colour);
}

static void colour_row(void *context, size_t y, int worker)
{
    const struct maps_fitting *w = context;
    const size_t width = (size_t)w->photos.width;
    struct look k;
    for (size_t x = 0; x < width; x++) {
        if (!is_known(w, y * width + x))
            continue;
        photos_look(&k, &w->photos, (int)x, (int)y, worker);
        colour_pixel(w, &k, y * width + x);
    }
}

static relume_status find_relief(struct maps_fitting *w)
{
    struct relume_maps *out = w->out;
    const struct relume_geometry *g = &out->geometry;
    const bool slab = g->projection == RELUME_SLAB;
    out->pixel =
        (slab ? g->st_max[0] - g->st_min[0] : g->window_max[0] - g->window_min[0]) / out->width;
    relume_status status = relume_height_integrate(
        &out->height_map, &out->normal,
        relume_height_params(.log = w->params.log, .pixel = out->pixel,
                             .threads = w->photos.threads, .confidence = &w->sure));
    if (!status)
        status = relume_height_occlusion(&out->occlusion, &out->height_map, out->pixel,
                                         w->photos.threads);
    return status;
}

// The codebook as it is shown, and how many pixels are nearest to each entry.
static void report_materials(const struct maps_fitting *w)
{
    struct relume_maps *out = w->out;
    size_t known = 0, near[RELUME_MAPS_MOST_MATERIALS] = {0};
    for (size_t at = 0; at < pixels_of(w); at++) {
        int best = 0;
        float least = INFINITY;
        if (!is_known(w, at))
            continue;
        for (int i = 0; i < w->materials.count; i++) {
            const struct gloss *g = &w->materials.gloss[i];
            const float far = fabsf(g->roughness - out->roughness.data[at]) +
                              fabsf(g->f0 - w->f0.data[at]) +
                              fabsf((g->metal ? 1.0f : 0.0f) - out->metallic.data[at]);
            if (far < least)
                best = i, least = far;
        }
        near[best]++;
        known++;
    }
    out->materials = w->materials.count;
    for (int i = 0; i < out->materials; i++)
        out->material[i] = (struct relume_maps_material){
            w->materials.gloss[i].metal, (double)w->materials.gloss[i].f0,
            (double)w->materials.gloss[i].roughness, (double)near[i] / (double)known};
}

static relume_status judge(struct maps_fitting *w)
{
    struct relume_maps *out = w->out;
    int some[MOST_JUDGED];
    const int n = w->fitted < MOST_JUDGED ? w->fitted : MOST_JUDGED;
    for (int i = 0; i < n; i++)
        some[i] = w->light[(int)((i + 0.5) * w->fitted / n)];
    const struct relume_maps_params *p = &w->params;
    relume_status status =
        maps_judge(&out->fitted, out, w->capture, p->view, some, n, w->photos.threads, p->log);
    if (!status)
        status = maps_judge(&out->held_out, out, w->capture, p->view, w->light + w->fitted, w->held,
                            w->photos.threads, p->log);
    return status;
}

static relume_status create_images(struct relume_maps *m)
{
    struct relume_image *const colours[] = {&m->normal, &m->base_color, &m->specular};
    struct relume_image *const values[] = {&m->roughness, &m->metallic, &m->confidence};
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < 3; i++) {
        status = relume_image_create(colours[i], m->width, m->height, 3);
        if (!status)
            status = relume_image_create(values[i], m->width, m->height, 1);
    }
    return status;
}

void relume_maps_destroy(struct relume_maps *maps)
{
    struct relume_image *const all[] = {&maps->normal,    &maps->base_color, &maps->roughness,
                                        &maps->metallic,  &maps->specular,   &maps->height_map,
                                        &maps->occlusion, &maps->confidence};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        relume_image_destroy(all[i]);
    *maps = (struct relume_maps){0};
}

static relume_status fit(struct maps_fitting *w)
{
    const struct relume_maps_params *p = &w->params;
    relume_status status = find_shape(w);
    if (!status)
        status =
            photos_open(&w->photos, w->capture, p->view, w->light, w->fitted, p->threads, p->log);
    if (!status)
        status = find_known(w);
    if (!status)
        status = find_gain(w);
    if (!status)
        status = find_materials(w);
    if (!status)
        status = create_images(w->out);
    if (!status)
        status = find_places(w);
    if (!status)
        status = photos_each(&w->photos, "colour", colour_row, w);
    if (!status) {
        report_materials(w);
        w->sure = w->shape.confidence;
        w->shape.confidence = (struct relume_image){0};
        relume_photometric_destroy(&w->shape);  // heights take as much memory again
        relume_image_destroy(&w->f0);
    }
    if (status || p->gloss_alone)
        return status;
    status = find_relief(w);
    return status ? status : judge(w);
}

relume_status relume_maps_fit(struct relume_maps *out, const relume_capture *capture,
                              const struct relume_maps_params *params)
{
    struct maps_fitting w = {
        .params = PARAMS_WORK(relume_maps_params, params), .out = out, .capture = capture};
    *out = (struct relume_maps){.width = relume_capture_width(capture),
                                .height = relume_capture_height(capture)};
    relume_status status = check(&w);
    if (!status) {
        const struct relume_manifest *m = relume_capture_manifest(capture);
        out->geometry = m->geometry;
        memcpy(out->uv, m->view[w.params.view].uv, sizeof out->uv);
        status = divide_lights(&w);
    }
    if (!status)
        status = fit(&w);
    photos_close(&w.photos);
    relume_photometric_destroy(&w.shape);
    relume_image_destroy(&w.sure);
    relume_image_destroy(&w.f0);
    mem_free(w.light);
    mem_free(w.memory);
    mem_free(w.learner);
    if (status)
        relume_maps_destroy(out);
    return status;
}
