// samples.c - pixels of a capture from which a learned basis learns
#include "base/log.h"
#include "base/memory.h"
#include "base/params.h"
#include "base/thread.h"
#include "coder/coefficients.h"
#include "image/image.h"
#include "math/random.h"
#include "selection/samples.h"

#include <string.h>

enum { DEFAULT_PIXELS = 65536, LEAST_PIXELS = 4096, ONE_LIGHT = 1 << 20 };

struct sampler {
    struct relume_samples *out;
    size_t *chosen;  // pixel numbers over all views, ascending
    size_t count, next;
    size_t kept;
    relume_table *table;  // of the view in progress
    size_t *place;        // [count]: where pixels lie in a band
    size_t taken;         // of them
};

// One pixel from each of `count` equal runs, at a place that no pattern of the image can follow.
static void choose(struct sampler *s, size_t pixels)
{
    struct random random = random_stream(1, pixels, s->count);
    for (size_t i = 0; i < s->count; i++) {
        const double at = ((double)i + random_next(&random)) * (double)pixels / (double)s->count;
        s->chosen[i] = at < (double)pixels ? (size_t)at : pixels - 1;
    }
}

static void take_light(void *context, size_t item, int worker)
{
    (void)worker;
    const struct sampler *s = context;
    for (size_t k = 0; k < s->taken; k++)
        relume_table_planes(s->table, (int)item, s->place[k], 1,
                            s->out->data + (item * s->count + s->kept + k) * 3, 1);
}

// Take the chosen pixels of a band whose first pixel has the number `first`.
static void take(struct sampler *s, const struct relume_image *mask, size_t n, size_t first,
                 size_t view_first, int threads)
{
    s->taken = 0;
    for (; s->next < s->count && s->chosen[s->next] < first + n; s->next++) {
        const size_t x = s->chosen[s->next] - first;
        if (!mask->data || mask->data[first - view_first + x] > 0.5f)
            s->place[s->taken++] = x;
    }
    thread_for(threads, s->taken ? (size_t)s->out->lights : 0, take_light, s);
    s->kept += s->taken;
}

static relume_status sample_view(struct sampler *s, const relume_capture *capture, int view,
                                 struct relume_transfer display,
                                 const struct relume_encode_params *p)
{
    const size_t width = (size_t)relume_capture_width(capture);
    const int height = relume_capture_height(capture);
    const size_t view_first = (size_t)view * width * (size_t)height;
    struct relume_image mask;
    relume_status status = relume_capture_mask(&mask, capture, view, p->log);
    if (!status)
        status = relume_table_open(
            &s->table, capture, view,
            relume_table_params(.log = p->log, .display = display, .threads = p->threads));
    for (int row = 0; !status && row < height; row += BAND_ROWS) {
        const int rows = height - row < BAND_ROWS ? height - row : BAND_ROWS;
        status = relume_table_fetch(s->table, rows);
        if (status)
            break;
        take(s, &mask, (size_t)rows * width, view_first + (size_t)row * width, view_first,
             p->threads);
        image_forget(&mask, row, rows);
        const int views = relume_capture_manifest(capture)->views;
        if (!log_progress(p->log, "sampling", (view + (row + rows) / (double)height) / views))
            status = RELUME_ECANCEL;
    }
    relume_table_destroy(&s->table);
    relume_image_destroy(&mask);
    return status;
}

relume_status relume_samples_read(struct relume_samples *out, const relume_capture *capture,
                                  size_t pixels, const struct relume_encode_params *params)
{
    const struct relume_encode_params p = PARAMS_WORK(relume_encode_params, params);
    const struct relume_manifest *m = relume_capture_manifest(capture);
    const size_t all = (size_t)m->views * (size_t)relume_capture_width(capture) *
                       (size_t)relume_capture_height(capture);
    const size_t want = pixels ? pixels : DEFAULT_PIXELS;
    *out = (struct relume_samples){.lights = m->lights};
    struct sampler s = {.out = out, .count = want < all ? want : all};
    s.chosen = mem_array(s.count, sizeof *s.chosen);
    s.place = mem_array(s.count, sizeof *s.place);
    out->data = mem_array((size_t)m->lights * s.count * 3, sizeof *out->data);
    relume_status status = s.chosen && s.place && out->data ? RELUME_OK : RELUME_ENOMEM;
    struct relume_transfer display = {.curve = RELUME_CURVE_LINEAR};
    if (relume_encode_domain(capture, p.domain) == RELUME_DOMAIN_DISPLAY)
        display = relume_encode_display(capture);
    if (!status)
        choose(&s, all);
    for (int v = 0; !status && v < m->views; v++)
        status = sample_view(&s, capture, v, display, &p);
    mem_free(s.chosen);
    mem_free(s.place);
    if (status)
        relume_samples_destroy(out);
    else {
        // Masked pixels left gaps at the end of every light's row.
        for (size_t i = 1; i < (size_t)s.out->lights; i++)
            memmove(s.out->data + i * s.kept * 3, s.out->data + i * s.count * 3,
                    s.kept * 3 * sizeof *s.out->data);
        s.out->pixels = s.kept;
    }
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

relume_status relume_coder_learn(relume_coder **out, const struct relume_basis *basis,
                                 const relume_capture *capture,
                                 const struct relume_coder_params *coder,
                                 const struct relume_encode_params *encode)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    struct relume_coder_params p = PARAMS_WORK(relume_coder_params, coder);
    struct relume_samples samples = {0};
    p.hemispherical = relume_capture_hemispherical(capture);
    p.pole_y = relume_capture_pole_y(capture);
    p.threads = encode ? encode->threads : 0;
    relume_status status = RELUME_OK;
    *out = NULL;
    if (basis->learned || p.choose) {
        status = relume_samples_read(&samples, capture, samples_enough(m->lights), encode);
        p.samples = &samples;
    }
    if (!status)
        status = relume_coder_create(out, basis, m->directions, m->lights, &p);
    relume_samples_destroy(&samples);
    return status;
}
