// heldout_load.c - the samples of a capture, or of bands of its rows where memory is short
#include "capture/manifest/reflectance_table.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/luminance.h"
#include "encode/choose/heldout.h"
#include "format/coder/basis.h"
#include "image/image/encoder.h"

#include <relume/relight/tone.h>
#include <string.h>

enum { BAND = 64, READ_ROWS = 16 };

// Per pixel and light: three floats, three codes and a luma.
static const double BYTES_A_SAMPLE = 3.0 * sizeof(float) + 3.0 + sizeof(float);

// Every view whole, or every `skip`-th band of all views one below the other.
static int choose_skip(const relume_heldout *h)
{
    const double need = BYTES_A_SAMPLE * h->all * (double)h->info.all_pixels;
    const double have = h->params.memory ? (double)h->params.memory : 0x1p30;
    const double skip = ceil(need / have);
    const int bands = h->views * ((h->height + BAND - 1) / BAND);
    return skip <= 1.0 ? 1 : skip < bands ? (int)skip : bands;
}

static void add_strip(relume_heldout *h, int view, int row, int rows)
{
    h->strip[h->strips++] =
        (struct strip){.view = view, .row = row, .rows = rows, .first = h->pixels};
    h->pixels += (size_t)rows * (size_t)h->width;
}

static relume_status make_strips(relume_heldout *h)
{
    const int skip = choose_skip(h), bands = (h->height + BAND - 1) / BAND;
    h->strip = mem_array((size_t)h->views * (size_t)bands, sizeof *h->strip);
    if (!h->strip)
        return RELUME_ENOMEM;
    for (int view = 0; view < h->views; view++) {
        if (skip == 1)
            add_strip(h, view, 0, h->height);
        for (int b = 0; skip > 1 && b < bands; b++)
            if ((view * bands + b) % skip == skip / 2)
                add_strip(h, view, b * BAND, b < bands - 1 ? BAND : h->height - b * BAND);
    }
    h->info.pixels = h->pixels;
    return RELUME_OK;
}

static relume_status make_chunks(relume_heldout *h)
{
    h->chunk = mem_array(h->pixels / CODER_CHUNK + (size_t)h->strips, sizeof *h->chunk);
    if (!h->chunk)
        return RELUME_ENOMEM;
    for (int i = 0; i < h->strips; i++) {
        const struct strip *s = &h->strip[i];
        const size_t end = s->first + (size_t)s->rows * (size_t)h->width;
        for (size_t at = s->first; at < end; at += CODER_CHUNK)
            h->chunk[h->chunks++] = (struct chunk){
                .view = s->view, .first = at, .n = end - at < CODER_CHUNK ? end - at : CODER_CHUNK};
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- masks

static relume_status load_mask(relume_heldout *h, int view)
{
    struct relume_image mask;
    const relume_status status = relume_capture_mask(&mask, h->capture, view, h->params.log);
    if (status || !mask.data)
        return status;
    h->masked[view] = true;
    if (!h->mask) {
        h->mask = mem_array(h->pixels, sizeof *h->mask);
        if (!h->mask) {
            relume_image_destroy(&mask);
            return RELUME_ENOMEM;
        }
        for (size_t i = 0; i < h->pixels; i++)
            h->mask[i] = 1.0f;
    }
    const size_t width = (size_t)h->width;
    for (int i = 0; i < h->strips; i++)
        if (h->strip[i].view == view)
            memcpy(h->mask + h->strip[i].first, mask.data + (size_t)h->strip[i].row * width,
                   (size_t)h->strip[i].rows * width * sizeof *mask.data);
    relume_image_destroy(&mask);
    return RELUME_OK;
}

// ---------------------------------------------------------------- samples

struct reading {
    relume_heldout *h;
    const relume_capture *capture;
    int first_light, lights;
    relume_table *table;
    float *rows;  // [lights][READ_ROWS][x][3]
    int next, view;
};

// Rows that lie in no strip are read past.
static relume_status read_rows(struct reading *r, int rows, const struct strip *s)
{
    const relume_heldout *h = r->h;
    const size_t band = (size_t)rows * (size_t)h->width * 3;
    const relume_status status = relume_table_read(r->table, rows, r->rows);
    const size_t first = s ? s->first + (size_t)(r->next - s->row) * (size_t)h->width : 0;
    for (int i = 0; !status && s && i < r->lights; i++)
        memcpy(h->samples + ((size_t)(r->first_light + i) * h->pixels + first) * 3,
               r->rows + (size_t)i * band, band * sizeof *r->rows);
    r->next += rows;
    return status;
}

static relume_status read_to(struct reading *r, int end, const struct strip *s, const char *what)
{
    relume_status status = RELUME_OK;
    while (!status && r->next < end) {
        status = read_rows(r, end - r->next < READ_ROWS ? end - r->next : READ_ROWS, s);
        const double done = (r->view + r->next / (double)r->h->height) / r->h->views;
        if (!status && !log_progress(r->h->params.log, what, done))
            status = RELUME_ECANCEL;
    }
    return status;
}

static relume_status read_view(struct reading *r)
{
    const relume_heldout *h = r->h;
    relume_status status =
        relume_table_open(&r->table, r->capture, r->view,
                          relume_table_params(.log = h->params.log, .display = h->curve,
                                              .threads = h->params.threads));
    r->next = 0;
    for (int i = 0; !status && i < h->strips; i++) {
        const struct strip *s = &h->strip[i];
        if (s->view != r->view)
            continue;
        status = read_to(r, s->row, NULL, "reading");
        if (!status)
            status = read_to(r, s->row + s->rows, s, "reading");
    }
    relume_table_destroy(&r->table);
    return status;
}

static relume_status read_capture(relume_heldout *h, const relume_capture *capture, int first_light)
{
    const int lights = relume_capture_manifest(capture)->lights;
    struct reading r = {.h = h, .capture = capture, .first_light = first_light, .lights = lights};
    r.rows = mem_array((size_t)lights * READ_ROWS * (size_t)h->width * 3, sizeof *r.rows);
    relume_status status = r.rows ? RELUME_OK : RELUME_ENOMEM;
    for (r.view = 0; !status && r.view < h->views; r.view++)
        status = read_view(&r);
    mem_free(r.rows);
    return status;
}

// ---------------------------------------------------------------- what is compared with

void heldout_encoder(struct encoder *e, const relume_heldout *h)
{
    const struct relume_transfer linear = {.curve = RELUME_CURVE_LINEAR};
    encoder_init_from(e, h->gain ? linear : h->curve, h->screen);
}

void heldout_show(const relume_heldout *h, const struct encoder *e, size_t light,
                  const float *value, float *out, size_t n)
{
    if (h->shown) {
        memmove(out, value, n * sizeof *out);
        return;
    }
    for (size_t i = 0; h->gain && i < n; i++)
        out[i] = h->gain[light] * relume_transfer_decode(h->curve, value[i]);
    encoder_apply(e, h->gain ? out : value, out, (int)n);
}

// What a photographer, or an eye, would expose each picture for.
static relume_status meter_lights(relume_heldout *h)
{
    const size_t n = 3 * h->pixels;
    struct relume_image light = {(int)h->pixels, 1, 3, .data = mem_array(n, sizeof *light.data)};
    h->gain = mem_array((size_t)h->all, sizeof *h->gain);
    const bool good = light.data && h->gain;
    for (size_t i = 0; good && i < (size_t)h->all; i++) {
        for (size_t x = 0; x < n; x++)
            light.data[x] = h->mask && !(h->mask[x / 3] > 0.5f)
                                ? 0.0f
                                : relume_transfer_decode(h->curve, h->samples[i * n + x]);
        h->gain[i] = (float)exp2(relume_tone_meter(&light));
    }
    mem_free(light.data);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

struct rounding {
    relume_heldout *h;
    struct encoder display;
};

static void round_light(void *context, size_t light, int worker)
{
    (void)worker;
    const struct rounding *r = context;
    const relume_heldout *h = r->h;
    for (size_t at = 0; at < h->pixels; at += CODER_CHUNK) {
        const size_t n = h->pixels - at < CODER_CHUNK ? h->pixels - at : CODER_CHUNK;
        const float *sample = h->samples + (light * h->pixels + at) * 3;
        uint8_t *code = h->codes + (light * h->pixels + at) * 3;
        float *luma = h->luma + light * h->pixels + at;
        float v[3 * CODER_CHUNK];
        heldout_show(h, &r->display, light, sample, v, 3 * n);
        for (size_t i = 0; i < 3 * n; i++) {
            v[i] = encoder_clip(v[i]);
            code[i] = (uint8_t)encoder_code(v[i]);
        }
        for (size_t i = 0; i < n; i++)
            luma[i] = luma_601f(v + 3 * i);
    }
}

static relume_status round_references(relume_heldout *h)
{
    struct rounding *r = mem_array(1, sizeof *r);
    if (!r)
        return RELUME_ENOMEM;
    r->h = h;
    heldout_encoder(&r->display, h);
    thread_for(h->params.threads, (size_t)h->all, round_light, r);
    mem_free(r);
    return RELUME_OK;
}

relume_status heldout_load(relume_heldout *h)
{
    relume_status status = make_strips(h);
    if (!status)
        status = make_chunks(h);
    if (status)
        return status;
    const size_t size = (size_t)h->all * h->pixels;
    h->samples = mem_array(size, 3 * sizeof *h->samples);
    h->codes = mem_array(size, 3);
    h->luma = mem_array(size, sizeof *h->luma);
    h->masked = mem_zeroed((size_t)h->views, sizeof *h->masked);
    if (!h->samples || !h->codes || !h->luma || !h->masked)
        return RELUME_ENOMEM;
    for (int view = 0; !status && view < h->views; view++)
        status = load_mask(h, view);
    if (!status)
        status = read_capture(h, h->capture, 0);
    if (!status && h->params.test)
        status = read_capture(h, h->params.test, h->lights);
    if (!status && h->params.tone_mapped)
        status = meter_lights(h);
    return status ? status : round_references(h);
}
