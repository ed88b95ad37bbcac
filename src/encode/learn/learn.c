// learn.c - how thick things are and what they would show in full light, from the photographs
#include "relight/shadow/shadows.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "core/math/lsq.h"
#include "core/math/luminance.h"
#include "format/pack/views.h"
#include "relight/shadow/moving.h"

#include <math.h>
#include <string.h>

enum { FREE = 0x8000 };  // the sign of half floats that are never below 0

// The photographs of a view.
struct looked {
    struct stage stage;
    size_t pixels;
    int lights;                   // that count
    vec3 *light, *turned;         // [lights], in the world, in the view
    uint16_t *grey;               // [lights][pixels]: luminance, half floats; FREE: nothing is in
                                  // the way of the light
    float *colour;                // [pixels][3]: sums over the lights
    float *bright;                // [pixels]: at least as bright is what light reaches
    float (*least)[STAGE_LEAST];  // [workers][pixels]
    int workers;
    int row;       // where the band begins
    float *model;  // [pixels][RELUME_SHADOW_CHANNELS]
};

static void looked_destroy(struct looked *l)
{
    stage_destroy(&l->stage);
    mem_free(l->light);
    mem_free(l->turned);
    mem_free(l->grey);
    mem_free(l->colour);
    mem_free(l->bright);
    mem_free(l->least);
}

// Bytes of all pixels: photographs, what is found, the surface with its depth.
static uint64_t held(const struct looked *l, int lights)
{
    const size_t found = 4 + RELUME_SHADOW_CHANNELS, surface = 5;
    return (uint64_t)l->pixels *
           ((uint64_t)lights * sizeof *l->grey + (uint64_t)l->workers * sizeof *l->least +
            (found + surface) * sizeof(float));
}

static relume_status looked_create(struct looked *l, const struct relume_manifest *m, int view,
                                   const struct relume_image *depth,
                                   const struct relume_shadows_params *p)
{
    const struct relume_geometry *g = m->slabs ? &m->slab[m->view[view].slab] : &m->geometry;
    enum { MOST_WORKERS = 4 };  // each has a copy of what is carved
    const int threads = thread_count(p->threads);
    l->pixels = (size_t)depth->width * (size_t)depth->height;
    l->workers = threads < MOST_WORKERS ? threads : MOST_WORKERS;
    relume_status status =
        limits_memory(NULL, held(l, m->lights), "tracing the shadows of a view", p->log);
    if (!status)
        status = stage_create(&l->stage, g, m->view[view].uv, depth);
    if (status)
        return status;
    l->light = mem_array((size_t)m->lights, sizeof *l->light);
    l->turned = mem_array((size_t)m->lights, sizeof *l->turned);
    l->grey = mem_array((size_t)m->lights * sizeof *l->grey, l->pixels);
    l->colour = mem_zeroed(l->pixels, 3 * sizeof *l->colour);
    l->bright = mem_zeroed(l->pixels, sizeof *l->bright);
    l->least = mem_array((size_t)l->workers * sizeof *l->least, l->pixels);
    if (!l->light || !l->turned || !l->grey || !l->colour || !l->bright || !l->least)
        status = RELUME_ENOMEM;
    return status;
}

// ---------------------------------------------------------------- photographs

// What half floats hold, 0 or more; not NAN.
static float most_half(float value)
{
    return fminf(fmaxf(value, 0.0f), 65504.0f);
}

static void take_picture(struct looked *l, const struct relume_image *image, vec3 light)
{
    uint16_t *grey = l->grey + (size_t)l->lights * l->pixels;
    for (size_t i = 0; i < l->pixels; i++) {
        const float *rgb = image->data + 3 * i, value = most_half(luminance_709f(rgb));
        grey[i] = half_from_float(value);
        l->bright[i] = fmaxf(l->bright[i], value);
        for (int c = 0; c < 3; c++)
            l->colour[3 * i + (size_t)c] += most_half(rgb[c]);
    }
    l->light[l->lights] = light;
    l->turned[l->lights++] = stage_turn(&l->stage, light);
}

// What light reaches is half as bright as the pixel is on average, and no deep shadow beside its
// brightest.
static void find_bright(struct looked *l)
{
    for (size_t i = 0; i < l->pixels; i++) {
        const float mean = luminance_709f(l->colour + 3 * i) / (float)l->lights;
        l->bright[i] = fmaxf(0.5f * mean, 0.15f * l->bright[i]);
    }
}

static relume_status look(struct looked *l, const relume_capture *capture, int view,
                          const struct relume_shadows_params *p)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < m->lights; i++) {
        struct relume_image image = {0};
        if (p->skip && p->skip[i])
            continue;
        if (!log_progress(p->log, "shadows", 0.2 * i / m->lights))
            return RELUME_ECANCEL;
        status = relume_capture_masked(&image, capture, view, i, p->log);
        if (!status)
            take_picture(l, &image, m->directions[i]);
        relume_image_destroy(&image);
    }
    find_bright(l);
    return status;
}

// ---------------------------------------------------------------- thickness

// Rows a few at a time: they take minutes where pixels and lights are many. `done`: of all.
static bool by_bands(struct looked *l, int threads, void (*row)(void *, size_t, int), double done,
                     const struct relume_log *log)
{
    const int height = l->stage.height, band = 8 * thread_count(threads);
    for (l->row = 0; l->row < height; l->row += band) {
        if (!log_progress(log, "shadows", done + 0.4 * l->row / height))
            return false;
        thread_for(threads, (size_t)(height - l->row < band ? height - l->row : band), row, l);
    }
    return true;
}

static bool is_lit(const struct looked *l, size_t pixel, float value)
{
    return value > 0.0f && value >= l->bright[pixel];
}

static void carve_row(void *context, size_t y, int worker)
{
    struct looked *l = context;
    float(*least)[STAGE_LEAST] = l->least + (size_t)worker * l->pixels;
    const size_t width = (size_t)l->stage.width;
    vec3 p;
    y += (size_t)l->row;
    for (size_t x = 0; x < width; x++) {
        uint16_t *grey = l->grey + y * width + x;
        if (!stage_point(&p, &l->stage, (double)x + 0.5, (double)y + 0.5))
            continue;
        for (int i = 0; i < l->lights; i++, grey += l->pixels)
            if (is_lit(l, y * width + x, float_from_half(*grey)) &&
                stage_carve(least, &l->stage, p, l->turned[i]))
                *grey |= FREE;
    }
}

// Some rays err, by a pixel at an edge: the smallest distances but a few are believed.
static bool carve(struct looked *l, const struct relume_log *log)
{
    for (size_t i = 0; i < (size_t)l->workers * l->pixels; i++)
        for (int k = 0; k < STAGE_LEAST; k++)
            l->least[i][k] = INFINITY;
    if (!by_bands(l, l->workers, carve_row, 0.2, log))
        return false;
    for (size_t i = 0; i < l->pixels; i++) {
        for (int w = 1; w < l->workers; w++)
            for (int k = 0; k < STAGE_LEAST; k++)
                stage_keep_least(l->least[i], l->least[(size_t)w * l->pixels + i][k]);
        l->stage.thick[i] = fminf(l->stage.thick[i], l->least[i][STAGE_LEAST - 1]);
    }
    return true;
}

// ---------------------------------------------------------------- matte

// The surface at the middle of a pixel; false outside, and for background. Panoramas go around.
static bool middle(vec3 *out, const struct stage *s, int x, int y)
{
    if (s->kind == STAGE_CYLINDER || s->kind == STAGE_SPHERE)
        x = index_wrapped(x, s->width);
    return x >= 0 && x < s->width && y >= 0 && y < s->height &&
           stage_point(out, s, x + 0.5, y + 0.5);
}

// Between a pixel and the nearer of its two neighbours along x or y, in that direction.
static bool step(vec3 *out, const struct stage *s, vec3 p, int x, int y, int dx, int dy)
{
    vec3 before, behind;
    const bool has_before = middle(&before, s, x - dx, y - dy),
               has_behind = middle(&behind, s, x + dx, y + dy);
    if (!has_before && !has_behind)
        return false;
    before = vec3_sub(p, before);
    behind = vec3_sub(behind, p);
    *out = !has_before || (has_behind && vec3_dot(behind, behind) < vec3_dot(before, before))
               ? behind
               : before;
    return true;
}

// Towards the eye, in the world; zero where neighbours do not tell.
static vec3 normal_at(const struct stage *s, vec3 p, int x, int y)
{
    vec3 across, down;
    if (!step(&across, s, p, x, y, 1, 0) || !step(&down, s, p, x, y, 0, 1))
        return (vec3){0.0, 0.0, 0.0};
    vec3 n = vec3_cross(down, across);
    const vec3 eye = s->kind == STAGE_FLAT ? (vec3){0.0, 0.0, -s->axis} : vec3_scale(p, -1.0);
    if (!(vec3_dot(n, n) > 0.0))
        return (vec3){0.0, 0.0, 0.0};
    if (vec3_dot(n, eye) < 0.0)
        n = vec3_scale(n, -1.0);
    return relume_pose_turn(&s->pose, vec3_unit(n));
}

// a + b.L by least squares over the lights that arrive; where these leave it open, in a room those
// from the walls, it is what Lambert's surface shows that is as bright in their light.
static void fit_pixel(const struct looked *l, size_t pixel, vec3 p, vec3 normal, float matte[4])
{
    const double trust = 3.0;  // in Lambert: as in so many lights
    double a[16] = {[0] = 0.01, [5] = trust, [10] = trust, [15] = trust}, x[4] = {0.0};
    double lambert = 0.0, cosines = 0.0;
    for (int i = 0; i < l->lights; i++) {
        const uint16_t grey = l->grey[(size_t)i * l->pixels + pixel];
        if (!(grey & FREE) && !stage_reaches(&l->stage, p, l->turned[i], INFINITY))
            continue;
        const double value = (double)float_from_half(grey & ~FREE);
        const double f[4] = {1.0, l->light[i].x, l->light[i].y, l->light[i].z};
        const double cosine = fmax(vec3_dot(normal, l->light[i]), 0.0);
        lambert += cosine * value, cosines += cosine * cosine;
        for (int r = 0; r < 4; r++) {
            x[r] += f[r] * value;
            for (int c = 0; c <= r; c++)
                a[4 * r + c] += f[r] * f[c];
        }
    }
    const vec3 b = vec3_scale(normal, cosines > 0.01 ? lambert / cosines : 0.0);
    x[1] += trust * b.x, x[2] += trust * b.y, x[3] += trust * b.z;
    const bool solved = lsq_solve(a, 4, x, 1);
    for (int i = 0; solved && i < 4; i++)
        matte[i] = (float)x[i];
}

static void fit_row(void *context, size_t y, int worker)
{
    (void)worker;
    struct looked *l = context;
    const size_t width = (size_t)l->stage.width;
    y += (size_t)l->row;
    for (size_t x = 0; x < width; x++) {
        const size_t pixel = y * width + x;
        float *model = l->model + RELUME_SHADOW_CHANNELS * pixel;
        const float *colour = l->colour + 3 * pixel, grey = luminance_709f(colour);
        vec3 p;
        memset(model, 0, RELUME_SHADOW_CHANNELS * sizeof *model);
        model[RELUME_SHADOW_THICK] = l->stage.thick[pixel];
        if (!stage_point(&p, &l->stage, (double)x + 0.5, (double)y + 0.5) || !(grey > 0.0f))
            continue;
        for (int c = 0; c < 3; c++)
            model[RELUME_SHADOW_COLOUR + c] = colour[c] / grey;
        fit_pixel(l, pixel, p, normal_at(&l->stage, p, (int)x, (int)y),
                  model + RELUME_SHADOW_MATTE);
    }
}

// ---------------------------------------------------------------- interface

static relume_status learn(struct relume_image *model, struct looked *l,
                           const relume_capture *capture, int view,
                           const struct relume_shadows_params *p)
{
    relume_status status = look(l, capture, view, p);
    if (status)
        return status;
    if (!carve(l, p->log))
        return RELUME_ECANCEL;
    status = relume_image_create(model, l->stage.width, l->stage.height, RELUME_SHADOW_CHANNELS);
    l->model = model->data;
    if (!status && !by_bands(l, p->threads, fit_row, 0.6, p->log))
        status = RELUME_ECANCEL;
    if (status)
        relume_image_destroy(model);
    return status;
}

relume_status relume_shadows_learn(struct relume_image *model, const relume_capture *capture,
                                   int view, const struct relume_shadows_params *params)
{
    const struct relume_shadows_params p = PARAMS_WORK(relume_shadows_params, params);
    const struct relume_manifest *m = relume_capture_manifest(capture);
    struct looked l = {.lights = 0};
    struct relume_image depth;
    *model = (struct relume_image){0};
    relume_status status = relume_capture_depth(&depth, capture, view, p.log);
    if (!status && (!depth.data || m->positions ||
                    !stage_suits(m->slabs ? &m->slab[m->view[view].slab] : &m->geometry)))
        status = RELUME_EINVAL;
    if (!status)
        status = looked_create(&l, m, view, &depth, &p);
    if (!status)
        status = learn(model, &l, capture, view, &p);
    looked_destroy(&l);
    relume_image_destroy(&depth);
    return status;
}
