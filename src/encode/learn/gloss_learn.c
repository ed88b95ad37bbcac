// gloss_learn.c - how much of each pixel's gloss counts, and whether it helps
//
// With B of the interpolant light i, foretold by all others, is missed by (B t)_i / B_ii (Dubrule
// 1983). What the model explains of that is its share: by least squares over lights and colours of
// what is missed of the photographs on what is missed of the model, held small where the model
// hardly changes anything.
#include "relight/shadow/gloss.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "format/coder/coding.h"
#include "format/pack/views.h"
#include "relight/shadow/moving.h"

#include <relume/material/maps.h>

#include <math.h>

enum { LEAST_LIGHTS = 12 };
static const float MOST_SHARE = 1.5f;
// Of the model's own misses, and of squares of white: 8 bits hold no less.
static const float RIDGE = 0.1f, LEAST = 0.003f;

struct learning {
    const relume_capture *capture;
    const struct relume_shadows_params *p;
    struct relume_image *model;
    struct relume_transfer display;
    bool coded;  // in the display domain
    int lights;
    float *misses;   // [lights][lights]: B, each row over its diagonal
    float *seen;     // [lights][RELUME_TABLE_ROWS][width][3]
    float *scratch;  // [workers][3][2][lights]
    int top, rows;   // of the band
};

static float code(const struct learning *l, float linear)
{
    return l->coded ? relume_transfer_encode(l->display, linear) : linear;
}

static float missed(const float *row, const float *values, int n)
{
    float sum = 0.0f;
    for (int i = 0; i < n; i++)
        sum += row[i] * values[i];
    return sum;
}

static float find_share(const struct learning *l, const float *pixel, size_t at, float *scratch)
{
    const size_t n = (size_t)l->lights, step = 3 * (size_t)l->rows * (size_t)l->model->width;
    const vec3 *light = relume_capture_manifest(l->capture)->directions;
    float both = 0.0f, own = 0.0f, rgb[3];
    for (size_t i = 0; i < n; i++) {
        gloss_shown(rgb, pixel, light[i]);
        for (size_t c = 0; c < 3; c++) {
            scratch[2 * c * n + i] = l->seen[i * step + 3 * at + c];
            scratch[(2 * c + 1) * n + i] = code(l, rgb[c]);
        }
    }
    for (size_t i = 0; i < n; i++)
        for (size_t c = 0; c < 3; c++) {
            const float *row = l->misses + i * n;
            const float seen = missed(row, scratch + 2 * c * n, l->lights);
            const float shown = missed(row, scratch + (2 * c + 1) * n, l->lights);
            both += seen * shown;
            own += shown * shown;
        }
    return fminf(fmaxf(both / ((1.0f + RIDGE) * own + LEAST), 0.0f), MOST_SHARE);
}

static void share_row(void *context, size_t row, int worker)
{
    const struct learning *l = context;
    const size_t width = (size_t)l->model->width;
    float *scratch = l->scratch + (size_t)worker * 6 * (size_t)l->lights;
    float *pixel = l->model->data + RELUME_GLOSS_CHANNELS * ((size_t)l->top + row) * width;
    for (size_t x = 0; x < width; x++, pixel += RELUME_GLOSS_CHANNELS)
        pixel[RELUME_GLOSS_SHARE] = find_share(l, pixel, row * width + x, scratch);
}

static relume_status find_shares(struct learning *l)
{
    relume_table *table = NULL;
    relume_status status = relume_table_open(
        &table, l->capture, 0,
        relume_table_params(.log = l->p->log, .threads = l->p->threads,
                            .display = l->coded ? l->display : (struct relume_transfer){0}));
    for (l->top = 0; !status && l->top < l->model->height; l->top += l->rows) {
        const int left = l->model->height - l->top;
        l->rows = left < RELUME_TABLE_ROWS ? left : RELUME_TABLE_ROWS;
        status = relume_table_read(table, l->rows, l->seen);
        if (!status)
            thread_for(l->p->threads, (size_t)l->rows, share_row, l);
        if (!status && !log_progress(l->p->log, "highlights", (double)l->top / l->model->height))
            status = RELUME_ECANCEL;
    }
    relume_table_destroy(&table);
    return status;
}

// ---------------------------------------------------------------- the surface

static void take_pixel(float *pixel, const struct relume_maps *maps, size_t at)
{
    const bool metal = maps->metallic.data[at] > 0.5f;
    const float gain = 1.0f / (float)maps->gain, shine = maps->specular.data[3 * at];
    for (size_t c = 0; c < 3; c++)
        pixel[RELUME_GLOSS_COLOUR + c] =
            gain * maps->base_color.data[3 * at + c] * (metal ? 1.0f : 1.0f - shine);
    for (size_t c = 0; c < 2; c++)
        pixel[RELUME_GLOSS_NORMAL + c] = maps->normal.data[3 * at + c];
    pixel[RELUME_GLOSS_ROUGHNESS] = maps->roughness.data[at];
    pixel[RELUME_GLOSS_SHINE] = metal ? -1.0f : gain * shine;
}

static relume_status take_maps(struct learning *l)
{
    struct relume_maps maps;
    relume_status status =
        relume_maps_fit(&maps, l->capture,
                        relume_maps_params(.log = l->p->log, .threads = l->p->threads,
                                           .held_out = -1, .gloss_alone = true));
    if (!status)
        status = relume_image_create(l->model, maps.width, maps.height, RELUME_GLOSS_CHANNELS);
    for (size_t i = 0; !status && i < (size_t)maps.width * (size_t)maps.height; i++)
        take_pixel(l->model->data + RELUME_GLOSS_CHANNELS * i, &maps, i);
    relume_maps_destroy(&maps);
    return status;
}

// ---------------------------------------------------------------- interpolation

static relume_status find_misses(struct learning *l, const relume_coder *coder)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    const size_t n = (size_t)info->lights;
    double *b = mem_array(n * n, sizeof *b);
    void *data = NULL;
    relume_status status = b ? info->interpolant->prepare(&data, info->directions, info->lights,
                                                          info->parameter, l->p->log)
                             : RELUME_ENOMEM;
    if (!status) {
        info->interpolant->predictor(data, b);
        info->interpolant->release(data);
        for (size_t i = 0; i < n * n; i++)
            l->misses[i] = (float)(b[i] / b[i / n * n + i / n]);
    }
    mem_free(b);
    return status;
}

static relume_status interpolate(relume_coder **coder, const relume_capture *capture, bool display,
                                 const struct relume_shadows_params *p)
{
    return relume_coder_learn(
        coder, relume_basis_find("table"), capture, relume_coder_params(.choose = true),
        relume_project_params(.log = p->log, .threads = p->threads,
                              .domain = display ? RELUME_DOMAIN_DISPLAY : RELUME_DOMAIN_LINEAR));
}

static bool suits(const relume_capture *capture)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    return m->views == 1 && !m->slabs && !m->positions && m->lights >= LEAST_LIGHTS &&
           m->geometry.projection == RELUME_PLANAR && !m->geometry.perspective;
}

static relume_status learn(struct learning *l, const relume_coder *coder)
{
    const size_t n = (size_t)l->lights, width = (size_t)relume_capture_width(l->capture);
    l->misses = mem_array(n * n, sizeof *l->misses);
    l->seen = mem_array(n * RELUME_TABLE_ROWS * 3 * sizeof *l->seen, width);
    l->scratch = mem_array((size_t)thread_count(l->p->threads) * 6 * n, sizeof *l->scratch);
    relume_status status = l->misses && l->seen && l->scratch ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = find_misses(l, coder);
    if (!status)
        status = take_maps(l);
    if (!status)
        status = find_shares(l);
    mem_free(l->misses);
    mem_free(l->seen);
    mem_free(l->scratch);
    if (status)
        relume_image_destroy(l->model);
    return status;
}

relume_status relume_gloss_learn(struct relume_image *model, const relume_capture *capture,
                                 bool display, const struct relume_shadows_params *params)
{
    const struct relume_shadows_params p = PARAMS_WORK(relume_shadows_params, params);
    struct learning l = {.capture = capture,
                         .p = &p,
                         .model = model,
                         .display = relume_encode_display(capture),
                         .coded = display,
                         .lights = relume_capture_manifest(capture)->lights};
    relume_coder *coder = NULL;
    *model = (struct relume_image){0};
    if (!suits(capture) || p.skip)
        return RELUME_EINVAL;
    relume_status status = interpolate(&coder, capture, display, &p);
    if (!status)
        status = learn(&l, coder);
    relume_coder_destroy(&coder);
    return status;
}
