// samples.c - pixels of a capture from which a learned basis learns
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/random.h"
#include "encode/choose/samples.h"
#include "capture/manifest/reflectance_table.h"
#include "encode/choose/sampling.h"
#include "format/coder/coding.h"
#include "image/image/image.h"

#include <string.h>

enum { DEFAULT_PIXELS = 65536, LEAST_PIXELS = 4096, ONE_LIGHT = 1 << 20 };

// A view that is read.
struct view_reader {
    struct sampling *g;
    const float *mask;  // or NULL: all of it counts
    relume_table *table;
    size_t first;   // the number of its first pixel
    size_t *place;  // [next]: where pixels lie in a band
    size_t taken;   // of them
};

// One pixel from each of `count` equal runs, at a place that no pattern of the image can follow.
static void choose_pixels(size_t *pixel, size_t count, size_t pixels)
{
    struct random random = random_stream(1, pixels, count);
    for (size_t i = 0; i < count; i++) {
        const double at = ((double)i + random_next(&random)) * (double)pixels / (double)count;
        pixel[i] = at < (double)pixels ? (size_t)at : pixels - 1;
    }
}

static void copy_light(void *context, size_t item, int worker)
{
    (void)worker;
    const struct view_reader *r = context;
    float *row = sampling_row(r->g, item) + 3 * r->g->shared;
    for (size_t k = 0; k < r->taken; k++)
        relume_table_planes(r->table, (int)item, r->place[k], 1, row + 3 * k, 1);
}

// The chosen pixels of a band whose first pixel has the number `first`.
static void copy_band(struct view_reader *r, size_t n, size_t first)
{
    struct sampling *g = r->g;
    r->taken = 0;
    for (; g->next < g->end && g->pixel[g->next] < first + n; g->next++) {
        const size_t x = g->pixel[g->next] - first;
        if (!r->mask || r->mask[first - r->first + x] > 0.5f)
            r->place[r->taken++] = x;
    }
    thread_for(g->p.threads, r->taken ? (size_t)g->out->lights : 0, copy_light, r);
    g->shared += r->taken;
}

static relume_status sample_view(struct sampling *g, int view, size_t *place)
{
    const struct relume_project_params *p = &g->p;
    const size_t width = (size_t)relume_capture_width(g->capture);
    const int height = relume_capture_height(g->capture);
    const int views = relume_capture_manifest(g->capture)->views;
    const int end = g->share.rows ? g->share.row + g->share.rows : height;
    struct view_reader r = {.g = g, .first = (size_t)view * width * (size_t)height, .place = place};
    struct relume_image mask;
    relume_status status = relume_capture_mask(&mask, g->capture, view, p->log);
    r.mask = status ? NULL : mask.data;
    if (!status)
        status = relume_table_open(
            &r.table, g->capture, view,
            relume_table_params(.log = p->log, .display = g->display, .threads = p->threads));
    if (!status)
        status = relume_table_skip(r.table, g->share.row);
    for (int row = g->share.row; !status && row < end; row += BAND_ROWS) {
        const int rows = end - row < BAND_ROWS ? end - row : BAND_ROWS;
        status = relume_table_fetch(r.table, rows);
        if (status)
            break;
        copy_band(&r, (size_t)rows * width, r.first + (size_t)row * width);
        image_forget(&mask, row, rows);
        if (!log_progress(p->log, "sampling", (view + (row + rows) / (double)height) / views))
            status = RELUME_ECANCEL;
    }
    relume_table_destroy(&r.table);
    relume_image_destroy(&mask);
    return status;
}

// ---------------------------------------------------------------- shares

// Which of the chosen pixels lie in the share.
static relume_status begin_share(void *context, int member)
{
    struct sampling *g = context;
    const size_t width = (size_t)relume_capture_width(g->capture);
    const size_t height = (size_t)relume_capture_height(g->capture);
    struct encode_share *share = &g->share;
    *share = (struct encode_share){.views = relume_capture_manifest(g->capture)->views};
    const relume_status status =
        g->p.team ? encode_share_find(share, member + 1, g->p.team->members, g->capture, g->p.log)
                  : RELUME_OK;
    if (status)
        return status;
    const size_t rows = share->rows ? (size_t)share->rows : height;
    const size_t first = ((size_t)share->first * height + (size_t)share->row) * width;
    const size_t end = first + ((size_t)(share->views - 1) * height + rows) * width;
    for (g->next = 0; g->next < g->count && g->pixel[g->next] < first;)
        g->next++;
    for (g->end = g->count; g->end > g->next && g->pixel[g->end - 1] >= end;)
        g->end--;
    g->shared = 0;
    return RELUME_OK;
}

static relume_status sample_share(void *context)
{
    struct sampling *g = context;
    size_t *place = mem_array(g->end - g->next, sizeof *place);
    relume_status status = place ? RELUME_OK : RELUME_ENOMEM;
    for (int v = 0; !status && v < g->share.views; v++)
        status = sample_view(g, g->share.first + v, place);
    mem_free(place);
    return status;
}

static relume_status add_share(void *context)
{
    struct sampling *g = context;
    g->out->pixels += g->shared;
    return RELUME_OK;
}

// Masked pixels left gaps at the end of every light's row.
static void close_gaps(struct relume_samples *s, size_t count)
{
    for (size_t i = 1; i < (size_t)s->lights; i++)
        memmove(s->data + i * s->pixels * 3, s->data + i * count * 3,
                s->pixels * 3 * sizeof *s->data);
}

static relume_status sample_pixels(struct sampling *g)
{
    static const struct team_work work = {begin_share, sample_share, add_share};
    struct relume_samples *out = g->out;
    out->data = mem_array((size_t)out->lights * g->count, 3 * sizeof *out->data);
    const relume_status status =
        out->data ? team_share(g->p.team, "samples", &work, g, &sampling_bytes, g, g->p.log)
                  : RELUME_ENOMEM;
    if (status)
        relume_samples_destroy(out);
    else
        close_gaps(out, g->count);
    return status;
}

relume_status relume_samples_read(struct relume_samples *out, const relume_capture *capture,
                                  size_t pixels, const struct relume_project_params *params)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    const size_t all = (size_t)m->views * (size_t)relume_capture_width(capture) *
                       (size_t)relume_capture_height(capture);
    const size_t want = pixels ? pixels : DEFAULT_PIXELS;
    struct sampling g = {.capture = capture,
                         .p = PARAMS_WORK(relume_project_params, params),
                         .display = {.curve = RELUME_CURVE_LINEAR},
                         .count = want < all ? want : all,
                         .out = out};
    *out = (struct relume_samples){.lights = m->lights};
    if (relume_capture_domain(capture, g.p.domain) == RELUME_DOMAIN_DISPLAY)
        g.display = relume_encode_curve(capture, g.p.display);
    g.pixel = mem_array(g.count, sizeof *g.pixel);
    if (!g.pixel)
        return RELUME_ENOMEM;
    choose_pixels(g.pixel, g.count, all);
    const relume_status status = sample_pixels(&g);
    mem_free(g.pixel);
    return status;
}

void relume_samples_destroy(struct relume_samples *samples)
{
    mem_free(samples->data);
    *samples = (struct relume_samples){0};
}

size_t samples_enough(int lights)
{
    const double values = 3.0 * lights, most = 1e11 / (values * values);
    if (lights == 1)
        return ONE_LIGHT;
    return most < LEAST_PIXELS     ? LEAST_PIXELS
           : most < DEFAULT_PIXELS ? (size_t)most
                                   : DEFAULT_PIXELS;
}
