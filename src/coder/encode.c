// encode.c - one view becomes coefficient planes
//
// The images are read in bands of rows, whose pixels become coefficients chunk by chunk (apply.c).
// Ranges for quantising are known only after the last band, so coefficients wait in a scratch file
// (coefficients.h).
#include "base/log.h"
#include "base/memory.h"
#include "base/params.h"
#include "base/scratch.h"
#include "base/thread.h"
#include "coder/basis.h"
#include "coder/census.h"
#include "coder/codes.h"
#include "coder/coefficients.h"
#include "coder/near_fit.h"
#include "image/encoder.h"
#include "base/half.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <string.h>

struct encoding {
    const relume_coder *coder;
    relume_coefficients *out;
    int lights, width, height, planes;
    int row, rows;  // of the band in progress
    relume_table *table;
    struct near_fit *near;  // or NULL: lights are distant, or the coder wants distant ones
    float *samples;         // [lights][rows][x][3], with `near`
    float *own;             // the same as pixels really saw them
    float *values;          // [planes][rows][x]
    struct range *chunk;    // [chunks of a band][planes]
    float *work;            // [workers][coder_work]
    void *packed[2];        // [rows][planes][x]: one is filled while the other is written
    int filling;
    struct thread_task writing;
    const void *write_from;
    size_t write_bytes;
    off_t write_at;
    int write_error;  // errno of a write that failed
    struct relume_image mask;
    const char *const *images;  // [lights], for messages
    struct range *total;        // [planes], masked pixels being 0
    struct captured captured;
    struct census census;
    size_t repaired;
    int end;            // the row behind the last that is encoded
    double *row_error;  // [height]
    double root_sum;
    struct relume_transfer display;  // of the samples
    struct encoder *screen;  // the display's coding of linear coefficients, or NULL: they are coded
    double *shown_error;     // [lights]: squared, of display values, by the basis
    double stored_error;     // mean square of them by storing
    size_t error_count, lit_count;
    int threads;
};

static bool is_inside(const struct relume_image *mask, size_t pixel)
{
    return !mask->data || mask->data[pixel] > 0.5f;
}

// Pixels outside the mask are 0.
static void apply_mask(const struct encoding *e, size_t first, size_t n)
{
    const size_t pixels = (size_t)e->rows * (size_t)e->width;
    const size_t at = (size_t)e->row * (size_t)e->width;
    for (size_t x = first; e->mask.data && x < first + n; x++)
        if (!is_inside(&e->mask, at + x))
            for (size_t p = 0; p < (size_t)e->planes; p++)
                e->values[p * pixels + x] = 0.0f;
}

static struct range band_range(const struct encoding *e, size_t plane)
{
    const size_t pixels = (size_t)e->rows * (size_t)e->width;
    struct range r = e->chunk[plane];
    for (size_t k = 1; k * CODER_CHUNK < pixels; k++)
        r = range_join(r, e->chunk[k * (size_t)e->planes + plane]);
    return range_settle(r);
}

// Samples of `n` pixels of the band: [channel][light][pixel].
static void gather(const struct encoding *e, size_t first, size_t n, float *separated)
{
    const size_t pixels = (size_t)e->rows * (size_t)e->width, lights = (size_t)e->lights;
    if (e->near)
        coder_separate(separated, e->samples + 3 * first, 3 * pixels, e->lights, n);
    else
        for (size_t i = 0; i < lights; i++)
            relume_table_planes(e->table, (int)i, first, n, separated + i * n, lights * n);
}

static void apply_chunk(void *context, size_t item, int worker)
{
    struct encoding *e = context;
    const size_t pixels = (size_t)e->rows * (size_t)e->width, first = item * CODER_CHUNK;
    const size_t n = pixels - first < CODER_CHUNK ? pixels - first : CODER_CHUNK;
    const size_t at = (size_t)e->row * (size_t)e->width + first;
    float *work = e->work + (size_t)worker * coder_work(e->coder);
    gather(e, first, n, work);
    census_add(&e->census, worker, work, n, e->mask.data ? e->mask.data + at : NULL);
    if (!e->near)
        coder_apply_separated(e->coder, n, e->values + first, pixels, work);
    apply_mask(e, first, n);
    for (size_t p = 0; p < (size_t)e->planes; p++)
        e->chunk[item * (size_t)e->planes + p] = range_of(e->values + p * pixels + first, n);
}

static void pack_plane(void *context, size_t plane, int worker)
{
    (void)worker;
    struct encoding *e = context;
    const size_t width = (size_t)e->width, pixels = (size_t)e->rows * width;
    const float *v = e->values + plane * pixels;
    const struct range r = band_range(e, plane);
    e->out->band[(size_t)(e->row / BAND_ROWS) * (size_t)e->planes + plane] = r;
    e->total[plane] = range_join(e->total[plane], r);
    for (int y = 0; y < e->rows; y++) {
        const size_t at = ((size_t)y * (size_t)e->planes + plane) * width;
        coefficients_wait(e->out, (int)plane, e->row, v + (size_t)y * width, width,
                          (char *)e->packed[e->filling] + at * coefficients_waiting(e->out));
    }
}

// The report looks at two rows of every fourth band, of every band in small images: not always the
// same ones, since the first rows of JPEG's blocks are better than the others.
static bool is_measured(const relume_coefficients *c, int row)
{
    enum { APART = BAND_ROWS / 2 };
    const int band = row / BAND_ROWS;
    return (c->bands < 64 || band % 4 == 0) && row % APART == band * 3 % APART;
}

// Black says nothing of what is typical.
static void add_root(struct encoding *e, double sample)
{
    e->root_sum += sample > 0.0 ? sqrt(sample) : 0.0;
    e->lit_count += sample > 0.0;
}

// The squared difference on a display.
static double shown_difference(const struct encoding *e, float a, float b)
{
    float v[2] = {a, b};
    if (e->screen)
        encoder_apply(e->screen, v, v, 2);
    const double d = (double)encoder_clip(v[0]) - (double)encoder_clip(v[1]);
    return d * d;
}

// What the basis cannot express, on a row of the band.
static relume_status measure_fit(struct encoding *e, int row)
{
    const size_t width = (size_t)e->width, pixels = (size_t)e->rows * width;
    const size_t size = (size_t)e->lights * width;
    float *again = mem_array(4 * size, sizeof *again);
    if (!again)
        return RELUME_ENOMEM;
    float *seen = again + size;
    for (size_t i = 0; i < (size_t)e->lights; i++)
        relume_table_planes(e->table, (int)i, (size_t)row * width, width, seen + i * width, size);
    for (int c = 0; c < 3; c++) {
        captured_predict(&e->captured, e->coder, c, e->values + (size_t)row * width, pixels, width,
                         again);
        for (size_t i = 0; i < (size_t)e->lights; i++)
            for (size_t x = 0; x < width; x++)
                if (is_inside(&e->mask, (size_t)(e->row + row) * width + x)) {
                    const double sample = (double)seen[(size_t)c * size + i * width + x];
                    const double d = sample - (double)again[i * width + x];
                    e->row_error[e->row + row] += d * d;
                    e->shown_error[i] += shown_difference(e, (float)sample, again[i * width + x]);
                    add_root(e, sample);
                    e->error_count++;
                }
    }
    mem_free(again);
    return RELUME_OK;
}

// The same of near lights: a pixel in 8.
static relume_status measure_near(struct encoding *e, int row)
{
    const size_t width = (size_t)e->width, pixels = (size_t)e->rows * width;
    float *again = mem_array(3 * (size_t)e->lights, sizeof *again);
    if (!again)
        return RELUME_ENOMEM;
    for (size_t x = 0; x < width; x += 8) {
        const size_t at = (size_t)row * width + x;
        if (!is_inside(&e->mask, (size_t)e->row * width + at))
            continue;
        near_fit_predict(e->near, (int)x, e->row + row, e->values + at, pixels, again);
        for (size_t i = 0; i < 3 * (size_t)e->lights; i++) {
            const double sample = (double)e->own[(i / 3 * pixels + at) * 3 + i % 3];
            const double d = sample - (double)again[i];
            e->row_error[e->row + row] += d * d;
            e->shown_error[i / 3] += shown_difference(e, (float)sample, again[i]);
            add_root(e, sample);
            e->error_count++;
        }
    }
    mem_free(again);
    return RELUME_OK;
}

// Ranges and steps are differences of coefficients, which must not overflow.
static relume_status check_size(const struct encoding *e, const struct relume_encode_params *p)
{
    const float most = FLT_MAX / 4.0f;
    const struct range *r = e->out->band + (size_t)(e->row / BAND_ROWS) * (size_t)e->planes;
    bool fits = true;
    for (int i = 0; i < e->planes; i++)
        fits &= r[i].min >= -most && r[i].min <= r[i].max && r[i].max <= most;
    if (fits)
        return RELUME_OK;
    return log_fail(p->log, RELUME_ELIMIT,
                    "%s: rows %d to %d are too bright to be stored; expected values of at most %g: "
                    "lower the exposure",
                    e->images[0], e->row, e->row + e->rows - 1, (double)most);
}

static void write_packed(void *context)
{
    struct encoding *e = context;
    if (!scratch_write(e->out->fd, e->write_from, e->write_bytes, e->write_at))
        e->write_error = errno;
}

static relume_status finish_writing(struct encoding *e, const struct relume_encode_params *p)
{
    thread_wait(&e->writing);
    if (!e->write_error)
        return RELUME_OK;
    return log_fail(p->log, RELUME_EIO, "%s: writing its temporary file failed; %s",
                    p->scratch ? p->scratch : "$TMPDIR", strerror(e->write_error));
}

// Send the band just packed to the scratch file while the next one is read.
static relume_status write_band(struct encoding *e, size_t pixels,
                                const struct relume_encode_params *p)
{
    const relume_status status = finish_writing(e, p);
    if (status)
        return status;
    e->write_from = e->packed[e->filling];
    e->write_bytes = pixels * (size_t)e->planes * coefficients_waiting(e->out);
    e->write_at = coefficients_offset(e->out, e->row);
    e->filling ^= 1;
    thread_start(&e->writing, write_packed, e);
    return RELUME_OK;
}

static relume_status read_band(struct encoding *e)
{
    e->rows = e->end - e->row < BAND_ROWS ? e->end - e->row : BAND_ROWS;
    return e->near ? relume_table_read_near(e->table, e->rows, e->samples, e->own)
                   : relume_table_fetch(e->table, e->rows);
}

static relume_status encode_band(struct encoding *e, const struct relume_encode_params *p)
{
    relume_status status = read_band(e);
    const size_t pixels = (size_t)e->rows * (size_t)e->width;
    if (!status && e->near)
        status = near_fit_apply(e->near, e->row, e->rows, e->own, e->samples, e->values);
    if (status)
        return status;
    thread_for(e->threads, (pixels + CODER_CHUNK - 1) / CODER_CHUNK, apply_chunk, e);
    for (int y = 0; !status && y < e->rows; y++)
        if (is_measured(e->out, e->row + y))
            status = e->near ? measure_near(e, y) : measure_fit(e, y);
    if (status)
        return status;
    thread_for(e->threads, (size_t)e->planes, pack_plane, e);
    status = check_size(e, p);
    if (status)
        return status;
    return write_band(e, pixels, p);
}

static void say_repaired(struct encoding *e, int light, size_t pixels, const struct relume_log *log)
{
    e->repaired += pixels;
    if (pixels)
        log_line(log, RELUME_WARNING, "%s: %zu pixel%s NaN or infinite; repaired from other lights",
                 e->images[light], pixels, pixels > 1 ? "s are" : " is");
}

static relume_status see_near(struct encoding *e)
{
    const size_t lights = 3 * (size_t)e->lights * BAND_ROWS, row = (size_t)e->width;
    e->samples = mem_array(lights, row * sizeof *e->samples);
    e->own = mem_array(lights, row * sizeof *e->own);
    if (!e->samples || !e->own)
        return RELUME_ENOMEM;
    return near_fit_create(&e->near, e->coder, e->table, e->width, e->height, e->threads);
}

static relume_status open_table(struct encoding *e, const relume_capture *capture, int view,
                                const struct relume_encode_params *p)
{
    const relume_status status = relume_table_open(
        &e->table, capture, view,
        relume_table_params(.log = p->log, .display = e->display, .threads = p->threads));
    return !status && relume_table_is_near(e->table) && near_fit_suits(e->coder) ? see_near(e)
                                                                                 : status;
}

static bool say_done(const struct encoding *e, const relume_capture *capture, int view,
                     const char *what, const struct relume_log *log)
{
    const int views = relume_capture_manifest(capture)->views;
    return log_progress(log, what, (view + (e->row + e->rows) / (double)e->height) / views);
}

static relume_status encode_bands(struct encoding *e, const relume_capture *capture, int view,
                                  const struct relume_encode_params *p)
{
    const int first = e->row;
    relume_status status = open_table(e, capture, view, p);
    if (!status)
        status = relume_table_skip(e->table, first);
    for (; !status && e->row < e->end; e->row += BAND_ROWS) {
        status = encode_band(e, p);
        if (!status && !say_done(e, capture, view, "encoding", p->log))
            status = RELUME_ECANCEL;
    }
    for (int i = 0; !status && i < e->lights; i++)
        say_repaired(e, i, relume_table_repaired(e->table, i), p->log);
    near_fit_destroy(&e->near);
    relume_table_destroy(&e->table);
    if (!status)
        return finish_writing(e, p);
    thread_wait(&e->writing);
    return status;
}

// One row of all planes as it waits and as it will be stored.
static relume_status read_row(const relume_coefficients *c, int row, uint16_t *waiting,
                              uint16_t *codes, float *before, float *after)
{
    const size_t width = (size_t)c->info.width, planes = (size_t)c->info.planes;
    const relume_status status = coefficients_values(c, row, waiting, before);
    for (size_t p = 0; !status && p < planes; p++) {
        coefficients_quantise(c, (int)p, row, waiting + p * width, width, codes);
        codes_restore(after + p * width, c->info.storage, codes, 0, width, c->scale[p],
                      c->offset[p]);
    }
    return status;
}

// What storing cost, over the captured lights, on the same rows.
static relume_status measure_storage(relume_coefficients *c, struct encoding *e)
{
    const size_t width = (size_t)c->info.width, planes = (size_t)c->info.planes;
    const size_t size = (size_t)e->lights * width;
    uint16_t *waiting = mem_array(planes * width, sizeof *waiting);
    uint16_t *codes = mem_array(width, sizeof *codes);
    float *before = mem_array(planes * width, sizeof *before);
    float *after = mem_array(planes * width, sizeof *after);
    float *wanted = mem_array(size, sizeof *wanted), *stored = mem_array(size, sizeof *stored);
    relume_status status =
        waiting && codes && before && after && wanted && stored ? RELUME_OK : RELUME_ENOMEM;
    double sum = 0.0;
    size_t count = 0;
    for (int row = 0; !status && row < e->height; row++) {
        if (!is_measured(c, row))
            continue;
        status = read_row(c, row, waiting, codes, before, after);
        for (int channel = 0; !status && channel < 3; channel++) {
            captured_predict(&e->captured, e->coder, channel, before, width, width, wanted);
            captured_predict(&e->captured, e->coder, channel, after, width, width, stored);
            for (size_t i = 0; i < size; i++)
                if (is_inside(&e->mask, (size_t)row * width + i % width)) {
                    const double d = (double)wanted[i] - (double)stored[i];
                    sum += d * d;
                    e->stored_error += shown_difference(e, wanted[i], stored[i]);
                    count++;
                }
        }
    }
    c->report.store_rms = count ? sqrt(sum / (double)count) : 0.0;
    e->stored_error /= count ? (double)count : 1.0;
    mem_free(waiting);
    mem_free(codes);
    mem_free(before);
    mem_free(after);
    mem_free(wanted);
    mem_free(stored);
    return status;
}

enum relume_domain relume_encode_domain(const relume_capture *capture, enum relume_domain domain)
{
    if (domain != RELUME_DOMAIN_AUTO)
        return domain;
    return relume_capture_manifest(capture)->transfer.curve == RELUME_CURVE_LINEAR
               ? RELUME_DOMAIN_LINEAR
               : RELUME_DOMAIN_DISPLAY;
}

struct relume_transfer relume_encode_display(const relume_capture *capture)
{
    const struct relume_transfer t = relume_capture_manifest(capture)->transfer;
    return t.curve == RELUME_CURVE_GAMMA ? t : (struct relume_transfer){.curve = RELUME_CURVE_SRGB};
}

// Mean over lights; those that are met exactly count as 100 dB.
static double shown_psnr(const struct encoding *e)
{
    const double each = (double)e->error_count / e->lights;
    double sum = 0.0;
    for (int i = 0; each > 0.0 && i < e->lights; i++)
        sum -= 10.0 * log10(fmax(e->shown_error[i] / each + e->stored_error, 1e-10)) / e->lights;
    return sum;
}

static double shown_square(const struct encoding *e)
{
    double sum = 0.0;
    for (int i = 0; i < e->lights; i++)
        sum += e->shown_error[i];
    return e->error_count ? sum / (double)e->error_count : 0.0;
}

// What measuring needs; linear coefficients are looked at on `screen`.
static relume_status alloc_measuring(struct encoding *e, struct relume_transfer screen)
{
    e->row_error = mem_zeroed((size_t)e->height, sizeof *e->row_error);
    e->shown_error = mem_zeroed((size_t)e->lights, sizeof *e->shown_error);
    if (!e->row_error || !e->shown_error)
        return RELUME_ENOMEM;
    if (e->display.curve == RELUME_CURVE_LINEAR) {
        e->screen = mem_array(1, sizeof *e->screen);
        if (!e->screen)
            return RELUME_ENOMEM;
        encoder_init(e->screen, screen);
    }
    return captured_create(&e->captured, e->coder, e->coder->world, e->lights);
}

static relume_status alloc_encoder(struct encoding *e, const relume_capture *capture)
{
    const size_t band = (size_t)BAND_ROWS * (size_t)e->width, planes = (size_t)e->planes;
    e->values = mem_array(planes * band, sizeof *e->values);
    e->chunk = mem_array((band + CODER_CHUNK - 1) / CODER_CHUNK * planes, sizeof *e->chunk);
    e->work = mem_array((size_t)thread_count(e->threads) * coder_work(e->coder), sizeof *e->work);
    for (int i = 0; i < 2; i++)
        e->packed[i] = mem_array(planes * band, coefficients_waiting(e->out));
    e->total = mem_array(planes, sizeof *e->total);
    if (!e->values || !e->chunk || !e->work || !e->packed[0] || !e->packed[1] || !e->total)
        return RELUME_ENOMEM;
    for (size_t p = 0; p < planes; p++)
        e->total[p] = (struct range){FLT_MAX, -FLT_MAX};
    return alloc_measuring(e, relume_encode_display(capture));
}

static void free_encoder(struct encoding *e)
{
    mem_free(e->samples);
    mem_free(e->own);
    mem_free(e->values);
    mem_free(e->chunk);
    mem_free(e->work);
    mem_free(e->packed[0]);
    mem_free(e->packed[1]);
    mem_free(e->total);
    mem_free(e->row_error);
    mem_free(e->shown_error);
    mem_free(e->screen);
    captured_destroy(&e->captured);
    census_destroy(&e->census);
    relume_image_destroy(&e->mask);
}

// Without memory so far, but for the mask.
static relume_status begin(struct encoding *e, const relume_coder *coder,
                           const relume_capture *capture, int view,
                           const struct relume_encode_params *p)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    *e = (struct encoding){
        .coder = coder,
        .lights = m->lights,
        .width = relume_capture_width(capture),
        .height = relume_capture_height(capture),
        .planes = coder->info.planes,
        .end = relume_capture_height(capture),
        .images = m->view[view].images,
        .display = {.curve = RELUME_CURVE_LINEAR},
        .threads = p->threads,
    };
    if (relume_encode_domain(capture, p->domain) == RELUME_DOMAIN_DISPLAY)
        e->display = relume_encode_display(capture);
    return relume_capture_mask(&e->mask, capture, view, p->log);
}

// Steps are chosen, and what was measured becomes the report.
static relume_status finish(relume_coefficients *c, struct encoding *e, enum relume_step step)
{
    struct relume_encode_report *r = &c->report;
    relume_status status = RELUME_OK;
    double error = 0.0;
    for (int y = 0; y < e->height; y++)
        error += e->row_error[y];
    r->fit_rms = e->error_count ? sqrt(error / (double)e->error_count) : 0.0;
    const double root = e->lit_count ? e->root_sum / (double)e->lit_count : 0.0;
    r->typical = root * root;
    coefficients_choose_steps(c, e->total, e->mask.data != NULL, step);
    if (relume_storage_top(c->info.storage))
        status = measure_storage(c, e);
    r->steps_rms = r->store_rms;
    r->psnr_db = shown_psnr(e);
    return status;
}

static void keep_sums(relume_coefficients *c, struct encoding *e)
{
    c->some.error = e->row_error;
    c->some.shown_error = e->shown_error;
    c->some.root_sum = e->root_sum;
    c->some.error_count = e->error_count;
    c->some.lit_count = e->lit_count;
    e->row_error = e->shown_error = NULL;
}

relume_status encode_some_rows(relume_coefficients **out, const relume_coder *coder,
                               const relume_capture *capture, int view, int row, int rows,
                               const struct relume_encode_params *params)
{
    const struct relume_encode_params p = PARAMS_WORK(relume_encode_params, params);
    const struct relume_manifest *m = relume_capture_manifest(capture);
    *out = NULL;
    if (!coder->map || m->lights != coder->info.lights || view < 0 || view >= m->views)
        return RELUME_EINVAL;

    relume_coefficients *c = NULL;
    struct encoding e;
    relume_status status = begin(&e, coder, capture, view, &p);
    if (!status)
        status = coefficients_create(&c, coder, e.width, e.height, &p);
    e.out = c;
    e.row = row;
    if (rows)
        e.end = row + rows;
    if (!status)
        status = alloc_encoder(&e, capture);
    if (!status)
        status = census_create(&e.census, capture, e.display, thread_count(p.threads));
    if (!status)
        status = encode_bands(&e, capture, view, &p);
    if (!status) {
        c->report.census = census_result(&e.census);
        c->report.census.repaired = e.repaired;
        c->some.row = row;
        c->some.rows = rows;
        if (rows)
            keep_sums(c, &e);
        else
            status = finish(c, &e, p.step);
    }
    free_encoder(&e);
    if (status)
        relume_coefficients_destroy(&c);
    *out = c;
    return status;
}

relume_status relume_encode(relume_coefficients **out, const relume_coder *coder,
                            const relume_capture *capture, int view,
                            const struct relume_encode_params *params)
{
    return encode_some_rows(out, coder, capture, view, 0, 0, params);
}

// ---------------------------------------------------------------- rows of several

static void join_bands(struct encoding *e, const relume_coefficients *c)
{
    for (size_t p = 0; p < (size_t)e->planes; p++) {
        e->total[p] = (struct range){FLT_MAX, -FLT_MAX};
        for (size_t b = 0; b < (size_t)c->bands; b++)
            e->total[p] = range_join(e->total[p], c->band[b * (size_t)e->planes + p]);
    }
}

relume_status encode_finish_rows(relume_coefficients *c, const struct relume_image *mask,
                                 struct relume_transfer display,
                                 const struct relume_encode_params *p)
{
    const bool coded = p->domain == RELUME_DOMAIN_DISPLAY;
    struct encoding e = {
        .coder = c->info.coder,
        .out = c,
        .lights = c->info.coder->info.lights,
        .width = c->info.width,
        .height = c->info.height,
        .planes = c->info.planes,
        .display = coded ? display : (struct relume_transfer){.curve = RELUME_CURVE_LINEAR},
        .root_sum = c->some.root_sum,
        .error_count = c->some.error_count,
        .lit_count = c->some.lit_count,
    };
    relume_status status = alloc_measuring(&e, display);
    e.total = mem_array((size_t)e.planes, sizeof *e.total);
    if (!status && !e.total)
        status = RELUME_ENOMEM;
    if (!status) {
        memcpy(e.row_error, c->some.error, (size_t)e.height * sizeof *e.row_error);
        memcpy(e.shown_error, c->some.shown_error, (size_t)e.lights * sizeof *e.shown_error);
        join_bands(&e, c);
        e.mask = *mask;
        status = finish(c, &e, p->step);
        e.mask = (struct relume_image){0};
    }
    free_encoder(&e);
    return status;
}

// ---------------------------------------------------------------- other coefficients

static relume_status judge_band(struct encoding *e, bool every, const struct encode_values *values)
{
    relume_status status = read_band(e);
    const size_t pixels = (size_t)e->rows * (size_t)e->width;
    for (int y = 0; !status && y < e->rows; y++)
        if (every || is_measured(e->out, e->row + y)) {
            values->row(values->user, e->row + y, e->values + (size_t)y * (size_t)e->width, pixels);
            status = e->near ? measure_near(e, y) : measure_fit(e, y);
        }
    return status;
}

relume_status encode_judge(struct encode_judgement *out, relume_coefficients *c,
                           const relume_capture *capture, int view, bool every,
                           const struct encode_values *values, const struct relume_encode_params *p)
{
    struct encoding e;
    relume_status status = begin(&e, c->info.coder, capture, view, p);
    e.out = c;
    if (!status)
        status = alloc_encoder(&e, capture);
    if (!status)
        status = open_table(&e, capture, view, p);
    for (e.row = 0; !status && e.row < e.height; e.row += BAND_ROWS) {
        status = judge_band(&e, every, values);
        if (!status && !say_done(&e, capture, view, "measuring", p->log))
            status = RELUME_ECANCEL;
    }
    *out = (struct encode_judgement){shown_psnr(&e), shown_square(&e)};
    near_fit_destroy(&e.near);
    relume_table_destroy(&e.table);
    free_encoder(&e);
    return status;
}
