// project.c - one view becomes coefficient planes
//
// The images are read in bands of rows, whose pixels become coefficients chunk by chunk (apply.c).
// Ranges for quantising are known only after the last band, so coefficients wait in a scratch file
// (coefficients.h).
#include "capture/manifest/reflectance_table.h"
#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/scratch.h"
#include "core/base/thread.h"
#include "format/coder/basis.h"
#include "format/coder/census.h"
#include "format/coder/codes.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"
#include "format/coder/near_fit.h"
#include "image/image/encoder.h"
#include "image/image/image.h"

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
    struct near_fit *near;       // or NULL: lights are distant, or the coder wants distant ones
    float *samples;              // [lights][rows][x][3], with `near`
    float *own;                  // the same as pixels really saw them
    float *values;               // [planes][rows][x]
    float *truth;                // likewise, what they are judged by where there is no table
    struct range *chunk;         // [chunks of a band][planes]
    float *work;                 // [workers][coder_work]
    float *piece;                // [workers][4][lights][PIECE], for measuring
    struct measured *sums;       // [pieces of the band's rows]
    double *shown;               // [the same][lights]
    int measured[BAND_ROWS];     // rows of the band that are looked at
    bool shown_only;             // of what is measured only squares of display values matter
    int apart;                   // tiles are judged on one row of these
    int run, first_run, runs;    // pixels of a row that are measured together, and which of them
    struct thread_task packing;  // of a band while the next one is read
    int packed_row, packed_rows;
    void *packed;     // [rows][planes][x]
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
    struct encoder *screen;          // from that to the screen's coding, or NULL: it is that
    double *shown_error;             // [lights]: squared, of display values, by the basis
    double stored_error;             // mean square of them by storing
    size_t error_count, lit_count;
    int threads;
};

// What measuring adds up of a piece of a row; pieces are added in their order.
struct measured {
    double error, root_sum;
    size_t count, lit;
};

enum { PIECE = 512 };  // the most pixels of a row that are measured together

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

static struct range band_range(const struct encoding *e, size_t plane, size_t pixels)
{
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
    const size_t width = (size_t)e->width, pixels = (size_t)e->packed_rows * width;
    const float *v = e->values + plane * pixels;
    const struct range r = band_range(e, plane, pixels);
    e->out->band[(size_t)(e->packed_row / BAND_ROWS) * (size_t)e->planes + plane] = r;
    e->total[plane] = range_join(e->total[plane], r);
    for (int y = 0; y < e->packed_rows; y++) {
        const size_t at = ((size_t)y * (size_t)e->planes + plane) * width;
        coefficients_wait(e->out, (int)plane, e->packed_row, v + (size_t)y * width, width,
                          (char *)e->packed + at * coefficients_waiting(e->out));
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
static void add_sample(struct measured *m, double sample, double difference)
{
    m->error += difference * difference;
    m->root_sum += sample > 0.0 ? sqrt(sample) : 0.0;
    m->lit += sample > 0.0;
    m->count++;
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

static int runs_of(const struct encoding *e)
{
    return (e->width + e->run - 1) / e->run;
}

// What a worker measures with.
static float *piece_work(const struct encoding *e, int worker)
{
    return e->piece + (size_t)worker * 4 * (size_t)e->lights * PIECE;
}

// The samples of a piece of a row: seen[3][lights][n].
static void take_seen(const struct encoding *e, size_t at, size_t n, float *seen)
{
    const size_t pixels = (size_t)e->rows * (size_t)e->width, size = (size_t)e->lights * n;
    for (int c = 0; e->truth && c < 3; c++)
        captured_predict(&e->captured, e->coder, c, e->truth + at, pixels, n,
                         seen + (size_t)c * size);
    for (size_t i = 0; !e->truth && i < (size_t)e->lights; i++)
        relume_table_planes(e->table, (int)i, at, n, seen + i * n, size);
}

// What the basis cannot express, on a piece of a row.
static void measure_fit(const struct encoding *e, int row, size_t first, size_t n, int worker,
                        struct measured *m, double *shown)
{
    const size_t width = (size_t)e->width, pixels = (size_t)e->rows * width;
    const size_t at = (size_t)row * width + first, size = (size_t)e->lights * n;
    float *again = piece_work(e, worker), *seen = again + size;
    take_seen(e, at, n, seen);
    for (int c = 0; c < 3; c++) {
        captured_predict(&e->captured, e->coder, c, e->values + at, pixels, n, again);
        for (size_t i = 0; i < (size_t)e->lights; i++)
            for (size_t x = 0; x < n; x++)
                if (is_inside(&e->mask, (size_t)e->row * width + at + x)) {
                    const float sample = seen[(size_t)c * size + i * n + x];
                    add_sample(m, (double)sample, (double)sample - (double)again[i * n + x]);
                    shown[i] += shown_difference(e, sample, again[i * n + x]);
                }
    }
}

// The same of near lights: a pixel in 8.
static void measure_near(const struct encoding *e, int row, size_t first, size_t n, int worker,
                         struct measured *m, double *shown)
{
    const size_t width = (size_t)e->width, pixels = (size_t)e->rows * width;
    float *again = piece_work(e, worker);
    for (size_t x = first; x < first + n; x += 8) {
        const size_t at = (size_t)row * width + x;
        if (!is_inside(&e->mask, (size_t)e->row * width + at))
            continue;
        near_fit_predict(e->near, worker, (int)x, e->row + row, e->values + at, pixels, again);
        for (size_t i = 0; i < 3 * (size_t)e->lights; i++) {
            const float sample = e->own[(i / 3 * pixels + at) * 3 + i % 3];
            add_sample(m, (double)sample, (double)sample - (double)again[i]);
            shown[i / 3] += shown_difference(e, sample, again[i]);
        }
    }
}

static double squares_between(const float *restrict a, const float *restrict b, size_t n)
{
    enum { LANES = 8 };
    float lane[LANES] = {0.0f};
    double sum = 0.0;
    size_t x = 0;
    for (; x + LANES <= n; x += LANES)
        for (size_t l = 0; l < LANES; l++) {
            const float d = encoder_clip(a[x + l]) - encoder_clip(b[x + l]);
            lane[l] += d * d;
        }
    for (; x < n; x++) {
        const float d = encoder_clip(a[x]) - encoder_clip(b[x]);
        lane[0] += d * d;
    }
    for (size_t l = 0; l < LANES; l++)
        sum += (double)lane[l];
    return sum;
}

// Differences alone, of display values, which are masked by making both the same.
static void measure_shown(const struct encoding *e, int row, size_t first, size_t n, int worker,
                          struct measured *m, double *shown)
{
    const size_t width = (size_t)e->width, pixels = (size_t)e->rows * width;
    const size_t at = (size_t)row * width + first, lights = (size_t)e->lights, size = lights * n;
    const size_t of_view = (size_t)e->row * width + at;
    float *again = piece_work(e, worker), *seen = again + size;
    size_t inside = 0;
    for (size_t x = 0; x < n; x++)
        inside += is_inside(&e->mask, of_view + x);
    if (inside)
        take_seen(e, at, n, seen);
    for (int c = 0; inside && c < 3; c++, seen += size) {
        captured_predict(&e->captured, e->coder, c, e->values + at, pixels, n, again);
        for (size_t x = 0; inside < n && x < n; x++)
            for (size_t i = 0; !is_inside(&e->mask, of_view + x) && i < lights; i++)
                again[i * n + x] = seen[i * n + x] = 0.0f;
        if (e->screen) {
            encoder_apply(e->screen, again, again, (int)size);
            encoder_apply(e->screen, seen, seen, (int)size);
        }
        for (size_t i = 0; i < lights; i++)
            shown[i] += squares_between(seen + i * n, again + i * n, n);
    }
    m->count += 3 * lights * inside;
}

static void measure_piece(void *context, size_t item, int worker)
{
    struct encoding *e = context;
    const size_t runs = (size_t)e->runs, lights = (size_t)e->lights, run = (size_t)e->run;
    const size_t first = ((size_t)e->first_run + item % runs) * run,
                 left = (size_t)e->width - first;
    const size_t n = left < run ? left : run;
    const int row = e->measured[item / runs];
    double *shown = e->shown + item * lights;
    e->sums[item] = (struct measured){0};
    memset(shown, 0, lights * sizeof *shown);
    (e->near         ? measure_near
     : e->shown_only ? measure_shown
                     : measure_fit)(e, row, first, n, worker, &e->sums[item], shown);
}

// One row of `apart`, in every band another, so that all rows of the blocks of coders count alike.
static bool is_judged(const struct encoding *e, int row)
{
    return row % e->apart == row / BAND_ROWS * 3 % e->apart;
}

// Rows that a report looks at, or judging tiles.
static bool is_looked_at(const struct encoding *e, int row)
{
    return e->apart ? is_judged(e, row) : is_measured(e->out, row);
}

// Some runs of those rows of the band that are looked at: so many items.
static size_t measure_runs(struct encoding *e)
{
    size_t rows = 0;
    for (int y = 0; y < e->rows; y++)
        if (is_looked_at(e, e->row + y))
            e->measured[rows++] = y;
    thread_for(e->threads, rows * (size_t)e->runs, measure_piece, e);
    return rows * (size_t)e->runs;
}

static void measure_band(struct encoding *e)
{
    const size_t lights = (size_t)e->lights, items = measure_runs(e);
    for (size_t k = 0; k < items; k++) {
        e->row_error[e->row + e->measured[k / (size_t)e->runs]] += e->sums[k].error;
        e->root_sum += e->sums[k].root_sum;
        e->error_count += e->sums[k].count;
        e->lit_count += e->sums[k].lit;
        for (size_t i = 0; i < lights; i++)
            e->shown_error[i] += e->shown[k * lights + i];
    }
}

// Ranges and steps are differences of coefficients, which must not overflow.
static relume_status check_size(const struct encoding *e, const struct relume_project_params *p)
{
    const float most = FLT_MAX / 4.0f;
    const struct range *r = e->out->band + (size_t)(e->packed_row / BAND_ROWS) * (size_t)e->planes;
    bool fits = true;
    for (int i = 0; i < (e->packed_rows ? e->planes : 0); i++)
        fits &= r[i].min >= -most && r[i].min <= r[i].max && r[i].max <= most;
    if (fits)
        return RELUME_OK;
    return log_fail(p->log, RELUME_ELIMIT,
                    "%s: rows %d to %d are too bright to be stored; expected values of at most %g: "
                    "lower the exposure",
                    e->images[0], e->packed_row, e->packed_row + e->packed_rows - 1, (double)most);
}

static void pack_band(void *context)
{
    struct encoding *e = context;
    const size_t n = (size_t)e->packed_rows * (size_t)e->width * (size_t)e->planes;
    thread_for(e->threads, (size_t)e->planes, pack_plane, e);
    if (!scratch_write(e->out->fd, e->packed, n * coefficients_waiting(e->out),
                       coefficients_offset(e->out, e->packed_row)))
        e->write_error = errno;
}

// The band just encoded goes to the scratch file while the next one is read.
static void start_packing(struct encoding *e)
{
    e->packed_row = e->row;
    e->packed_rows = e->rows;
    if (thread_count(e->threads) > 1)
        thread_start(&e->packing, pack_band, e);
    else
        pack_band(e);
}

static relume_status finish_packing(struct encoding *e, const struct relume_project_params *p)
{
    thread_wait(&e->packing);
    if (!e->write_error)
        return check_size(e, p);
    return log_fail(p->log, RELUME_EIO, "%s: writing its temporary file failed; %s",
                    p->scratch ? p->scratch : "$TMPDIR", strerror(e->write_error));
}

// The values of the coefficients themselves, row by row.
static relume_status read_truth(struct encoding *e)
{
    const size_t width = (size_t)e->width, pixels = (size_t)e->rows * width;
    const size_t planes = (size_t)e->planes;
    float *row = mem_array(planes, width * sizeof *row);
    relume_status status = row ? RELUME_OK : RELUME_ENOMEM;
    for (size_t y = 0; !status && y < (size_t)e->rows; y++) {
        status = coefficients_values(e->out, e->row + (int)y, e->packed, row);
        for (size_t p = 0; !status && p < planes; p++)
            memcpy(e->truth + p * pixels + y * width, row + p * width, width * sizeof *row);
    }
    mem_free(row);
    return status;
}

static relume_status read_band(struct encoding *e)
{
    e->rows = e->end - e->row < BAND_ROWS ? e->end - e->row : BAND_ROWS;
    if (e->truth)
        return read_truth(e);
    return e->near ? relume_table_read_near(e->table, e->rows, e->samples, e->own)
                   : relume_table_fetch(e->table, e->rows);
}

static relume_status encode_band(struct encoding *e, const struct relume_project_params *p)
{
    relume_status status = read_band(e);
    const size_t pixels = (size_t)e->rows * (size_t)e->width;
    if (!status)
        status = finish_packing(e, p);
    if (!status && e->near)
        status = near_fit_apply(e->near, e->row, e->rows, e->own, e->samples, e->values);
    if (status)
        return status;
    thread_for(e->threads, (pixels + CODER_CHUNK - 1) / CODER_CHUNK, apply_chunk, e);
    measure_band(e);
    start_packing(e);
    return RELUME_OK;
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
                                const struct relume_project_params *p)
{
    const relume_status status = relume_table_open(
        &e->table, capture, view,
        relume_table_params(.log = p->log, .display = e->display, .threads = p->threads));
    return !status && relume_table_is_near(e->table) && near_fit_suits(e->coder) ? see_near(e)
                                                                                 : status;
}

// The band has been looked at.
static bool say_done(const struct encoding *e, const relume_capture *capture, int view,
                     const char *what, const struct relume_log *log)
{
    const int views = relume_capture_manifest(capture)->views;
    image_forget(&e->mask, e->row, e->rows);
    return log_progress(log, what, (view + (e->row + e->rows) / (double)e->height) / views);
}

static relume_status encode_bands(struct encoding *e, const relume_capture *capture, int view,
                                  const struct relume_project_params *p)
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
        return finish_packing(e, p);
    thread_wait(&e->packing);
    return status;
}

// One worker's.
struct stored_row {
    uint16_t *waiting, *codes;  // [planes][x], [x]
    float *before, *after;      // [planes][x]: as it waits, as it will be stored
    float *wanted, *again;      // [lights][x]: values of these
};

struct storage {
    const struct encoding *e;
    relume_coefficients *c;
    struct encode_stored *row;  // [height]
    struct stored_row *work;    // [workers]
};

static bool alloc_row(struct stored_row *w, size_t width, size_t planes, size_t lights)
{
    w->waiting = mem_array(planes * width, sizeof *w->waiting);
    w->codes = mem_array(width, sizeof *w->codes);
    w->before = mem_array(2 * planes * width, sizeof *w->before);
    w->wanted = mem_array(2 * lights * width, sizeof *w->wanted);
    w->after = w->before + planes * width;
    w->again = w->wanted + lights * width;
    return w->waiting && w->codes && w->before && w->wanted;
}

static void free_row(struct stored_row *w)
{
    mem_free(w->waiting);
    mem_free(w->codes);
    mem_free(w->before);
    mem_free(w->wanted);
}

static relume_status read_row(const relume_coefficients *c, int row, const struct stored_row *w)
{
    const size_t width = (size_t)c->info.width, planes = (size_t)c->info.planes;
    const relume_status status = coefficients_values(c, row, w->waiting, w->before);
    for (size_t p = 0; !status && p < planes; p++) {
        coefficients_quantise(c, (int)p, row, w->waiting + p * width, width, w->codes);
        codes_restore(w->after + p * width, c->info.storage, w->codes, 0, width, c->scale[p],
                      c->offset[p]);
    }
    return status;
}

static void compare_row(void *context, size_t item, int worker)
{
    const struct storage *s = context;
    const struct encoding *e = s->e;
    const struct stored_row *w = &s->work[worker];
    struct encode_stored *r = &s->row[item];
    const size_t width = (size_t)e->width, size = (size_t)e->lights * width;
    const struct project_rows *some = &s->c->some;
    if (!is_measured(s->c, (int)item) ||
        (some->rows && ((int)item < some->row || (int)item >= some->row + some->rows)))
        return;
    r->status = read_row(s->c, (int)item, w);
    for (int channel = 0; !r->status && channel < 3; channel++) {
        captured_predict(&e->captured, e->coder, channel, w->before, width, width, w->wanted);
        captured_predict(&e->captured, e->coder, channel, w->after, width, width, w->again);
        for (size_t i = 0; i < size; i++)
            if (is_inside(&e->mask, item * width + i % width)) {
                const double d = (double)w->wanted[i] - (double)w->again[i];
                r->square += d * d;
                r->shown += shown_difference(e, w->wanted[i], w->again[i]);
                r->count++;
            }
    }
    image_forget(&e->mask, (int)item, 1);
}

static relume_status add_rows(struct relume_fidelity *r, struct encoding *e,
                              const struct encode_stored *row)
{
    struct encode_stored all = {0};
    for (int y = 0; y < e->height && !all.status; y++) {
        all.status = row[y].status;
        all.square += row[y].square;
        all.shown += row[y].shown;
        all.count += row[y].count;
    }
    r->store_rms = all.count ? sqrt(all.square / (double)all.count) : 0.0;
    e->stored_error = all.shown / (all.count ? (double)all.count : 1.0);
    return all.status;
}

// What storing cost, over the captured lights, on the same rows.
static relume_status measure_storage(struct encode_stored *row, relume_coefficients *c,
                                     struct encoding *e)
{
    const int workers = thread_count(e->threads);
    struct storage s = {e, c, row, mem_zeroed((size_t)workers, sizeof *s.work)};
    bool good = s.row && s.work;
    for (int i = 0; good && i < workers; i++)
        good = alloc_row(&s.work[i], (size_t)e->width, (size_t)e->planes, (size_t)e->lights);
    if (good)
        thread_for(e->threads, (size_t)e->height, compare_row, &s);
    for (int i = 0; s.work && i < workers; i++)
        free_row(&s.work[i]);
    mem_free(s.work);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

relume_status relume_domain_parse(enum relume_domain *out, struct relume_transfer *display,
                                  const char *text)
{
    static const char *const names[] = {"auto", "linear", "display"};
    *display = (struct relume_transfer){.curve = RELUME_CURVE_AUTO};
    for (int i = 0; i < 3; i++)
        if (!strcmp(names[i], text)) {
            *out = (enum relume_domain)i;
            return RELUME_OK;
        }
    *out = RELUME_DOMAIN_DISPLAY;
    *display = (struct relume_transfer){.curve = RELUME_CURVE_LOG, .gamma = RELUME_LOG_DELTA};
    if (!strcmp(text, "log"))
        return RELUME_OK;
    return strncmp(text, "log:", 4) ? RELUME_EINVAL : relume_transfer_parse(display, text);
}

const char *relume_domain_name(enum relume_domain domain, struct relume_transfer display)
{
    return domain == RELUME_DOMAIN_AUTO        ? "auto"
           : domain == RELUME_DOMAIN_LINEAR    ? "linear"
           : display.curve == RELUME_CURVE_LOG ? "log"
                                               : "display";
}

enum relume_domain relume_capture_domain(const relume_capture *capture, enum relume_domain domain)
{
    if (domain != RELUME_DOMAIN_AUTO)
        return domain;
    const struct relume_manifest *m = relume_capture_manifest(capture);
    return m->transfer.curve == RELUME_CURVE_LINEAR && !m->display_coded ? RELUME_DOMAIN_LINEAR
                                                                         : RELUME_DOMAIN_DISPLAY;
}

struct relume_transfer relume_encode_display(const relume_capture *capture)
{
    const struct relume_transfer t = relume_capture_manifest(capture)->transfer;
    return t.curve == RELUME_CURVE_GAMMA ? t : (struct relume_transfer){.curve = RELUME_CURVE_SRGB};
}

struct relume_transfer relume_encode_curve(const relume_capture *capture,
                                           struct relume_transfer asked)
{
    return asked.curve == RELUME_CURVE_AUTO ? relume_encode_display(capture) : asked;
}

// Mean over lights; those that are reproduced exactly count as 100 dB.
static double shown_psnr(const struct encoding *e)
{
    const double each = (double)e->error_count / e->lights;
    double sum = 0.0;
    for (int i = 0; each > 0.0 && i < e->lights; i++)
        sum -= 10.0 * log10(fmax(e->shown_error[i] / each + e->stored_error, 1e-10)) / e->lights;
    return sum;
}

// What measuring needs; coefficients that are no display values are looked at on `screen`.
static relume_status alloc_measuring(struct encoding *e, struct relume_transfer screen)
{
    e->row_error = mem_zeroed((size_t)e->height, sizeof *e->row_error);
    e->shown_error = mem_zeroed((size_t)e->lights, sizeof *e->shown_error);
    if (!e->row_error || !e->shown_error)
        return RELUME_ENOMEM;
    if (e->display.curve == RELUME_CURVE_LINEAR || e->display.curve == RELUME_CURVE_LOG) {
        e->screen = mem_array(1, sizeof *e->screen);
        if (!e->screen)
            return RELUME_ENOMEM;
        encoder_init_from(e->screen, e->display, screen);
    }
    return captured_create(&e->captured, e->coder, e->coder->world, e->lights);
}

static relume_status alloc_encoder(struct encoding *e, const relume_capture *capture)
{
    const size_t band = (size_t)BAND_ROWS * (size_t)e->width, planes = (size_t)e->planes;
    e->values = mem_array(planes * band, sizeof *e->values);
    e->chunk = mem_array((band + CODER_CHUNK - 1) / CODER_CHUNK * planes, sizeof *e->chunk);
    e->work = mem_array((size_t)thread_count(e->threads) * coder_work(e->coder), sizeof *e->work);
    e->piece = mem_array((size_t)thread_count(e->threads) * 4 * (size_t)e->lights,
                         PIECE * sizeof *e->piece);
    e->sums = mem_array(BAND_ROWS * (size_t)runs_of(e), sizeof *e->sums);
    e->shown = mem_array(BAND_ROWS * (size_t)runs_of(e) * (size_t)e->lights, sizeof *e->shown);
    e->packed = mem_array(planes * band, coefficients_waiting(e->out));
    e->total = mem_array(planes, sizeof *e->total);
    if (!e->values || !e->chunk || !e->work || !e->piece || !e->sums || !e->shown || !e->packed ||
        !e->total)
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
    mem_free(e->truth);
    mem_free(e->chunk);
    mem_free(e->work);
    mem_free(e->piece);
    mem_free(e->sums);
    mem_free(e->shown);
    mem_free(e->packed);
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
                           const struct relume_project_params *p)
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
        .run = PIECE,
        .threads = p->threads,
    };
    e->runs = runs_of(e);
    if (relume_capture_domain(capture, p->domain) == RELUME_DOMAIN_DISPLAY)
        e->display = relume_encode_curve(capture, p->display);
    return relume_capture_mask(&e->mask, capture, view, p->log);
}

// What was measured becomes the report.
static relume_status fill_report(struct relume_fidelity *r, struct encoding *e,
                                 const struct encode_stored *row)
{
    relume_status status = RELUME_OK;
    double error = 0.0;
    for (int y = 0; y < e->height; y++)
        error += e->row_error[y];
    r->fit_rms = e->error_count ? sqrt(error / (double)e->error_count) : 0.0;
    const double root = e->lit_count ? e->root_sum / (double)e->lit_count : 0.0;
    r->typical = root * root;
    if (row)
        status = add_rows(r, e, row);
    r->steps_rms = r->store_rms;
    r->psnr_db = shown_psnr(e);
    return status;
}

static relume_status finish(relume_coefficients *c, struct encoding *e, enum relume_step step)
{
    struct encode_stored *row = NULL;
    relume_status status = RELUME_OK;
    coefficients_choose_steps(c, e->total, e->mask.data != NULL, step);
    if (relume_storage_top(c->info.storage)) {
        row = mem_zeroed((size_t)e->height, sizeof *row);
        status = measure_storage(row, c, e);
    }
    if (!status)
        status = fill_report(&c->report, e, row);
    mem_free(row);
    return status;
}

static relume_status keep_sums(relume_coefficients *c, struct encoding *e)
{
    mem_free(c->some.error);
    mem_free(c->some.shown_error);
    mem_free(c->some.lit);
    c->some.error = e->row_error;
    c->some.shown_error = e->shown_error;
    c->some.root_sum = e->root_sum;
    c->some.error_count = e->error_count;
    c->some.lit_count = e->lit_count;
    e->row_error = e->shown_error = NULL;
    c->some.lit = mem_array((size_t)e->lights, sizeof *c->some.lit);
    for (int i = 0; c->some.lit && i < e->lights; i++)
        c->some.lit[i] = census_is_lit(&e->census, i);
    return c->some.lit ? RELUME_OK : RELUME_ENOMEM;
}

// Rows of a view, 0: all of them, into `c`; what a report needs of them is left in `e`.
static relume_status encode_into(struct encoding *e, relume_coefficients *c,
                                 const relume_capture *capture, int view, int row, int rows,
                                 const struct relume_project_params *p)
{
    e->out = c;
    e->row = row;
    if (rows)
        e->end = row + rows;
    relume_status status = alloc_encoder(e, capture);
    if (!status)
        status = census_create(&e->census, capture, e->display, thread_count(p->threads));
    if (!status)
        status = encode_bands(e, capture, view, p);
    if (!status) {
        c->report.census = census_result(&e->census);
        c->report.census.repaired = e->repaired;
        c->some.row = row;
        c->some.rows = rows;
    }
    return status;
}

relume_status project_more_rows(relume_coefficients *c, const relume_capture *capture, int view,
                                int row, int rows, const struct relume_project_params *params)
{
    const struct relume_project_params p = PARAMS_WORK(relume_project_params, params);
    struct encoding e;
    relume_status status = begin(&e, c->info.coder, capture, view, &p);
    if (!status)
        status = encode_into(&e, c, capture, view, row, rows, &p);
    if (!status)
        status = keep_sums(c, &e);
    free_encoder(&e);
    return status;
}

relume_status project_some_rows(relume_coefficients **out, const relume_coder *coder,
                                const relume_capture *capture, int view, int row, int rows,
                                const struct relume_project_params *params)
{
    const struct relume_project_params p = PARAMS_WORK(relume_project_params, params);
    const struct relume_manifest *m = relume_capture_manifest(capture);
    *out = NULL;
    if (!coder->map || m->lights != coder->info.lights || view < 0 || view >= m->views)
        return RELUME_EINVAL;

    relume_coefficients *c = NULL;
    struct encoding e;
    relume_status status = begin(&e, coder, capture, view, &p);
    if (!status)
        status = coefficients_create(&c, coder, e.width, e.height, &p);
    if (!status)
        status = encode_into(&e, c, capture, view, row, rows, &p);
    if (!status)
        status = rows ? keep_sums(c, &e) : finish(c, &e, p.step);
    free_encoder(&e);
    if (status)
        relume_coefficients_destroy(&c);
    *out = c;
    return status;
}

relume_status relume_project(relume_coefficients **out, const relume_coder *coder,
                             const relume_capture *capture, int view,
                             const struct relume_project_params *params)
{
    return project_some_rows(out, coder, capture, view, 0, 0, params);
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

// What rows of several know of the view, before steps are chosen.
static relume_status begin_rows(struct encoding *e, relume_coefficients *c,
                                const struct relume_image *mask, struct relume_transfer display,
                                const struct relume_project_params *p)
{
    const bool coded = p->domain == RELUME_DOMAIN_DISPLAY;
    *e = (struct encoding){
        .coder = c->info.coder,
        .out = c,
        .lights = c->info.coder->info.lights,
        .width = c->info.width,
        .height = c->info.height,
        .planes = c->info.planes,
        .display = coded ? display : (struct relume_transfer){.curve = RELUME_CURVE_LINEAR},
        .threads = p->threads,
        .root_sum = c->some.root_sum,
        .error_count = c->some.error_count,
        .lit_count = c->some.lit_count,
    };
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    relume_status status = alloc_measuring(e, display.curve == RELUME_CURVE_LOG ? srgb : display);
    e->total = mem_array((size_t)e->planes, sizeof *e->total);
    if (!status && !e->total)
        status = RELUME_ENOMEM;
    if (status)
        return status;
    memcpy(e->row_error, c->some.error, (size_t)e->height * sizeof *e->row_error);
    memcpy(e->shown_error, c->some.shown_error, (size_t)e->lights * sizeof *e->shown_error);
    join_bands(e, c);
    e->mask = *mask;
    return RELUME_OK;
}

static void end_rows(struct encoding *e)
{
    e->mask = (struct relume_image){0};
    free_encoder(e);
}

relume_status project_finish_rows(relume_coefficients *c, const struct relume_image *mask,
                                  struct relume_transfer display,
                                  const struct relume_project_params *p)
{
    struct encoding e;
    relume_status status = begin_rows(&e, c, mask, display, p);
    if (!status)
        status = finish(c, &e, p->step);
    end_rows(&e);
    return status;
}

relume_status project_settle_rows(relume_coefficients *c, const struct relume_image *mask,
                                  struct relume_transfer display,
                                  const struct relume_project_params *p)
{
    struct encoding e;
    relume_status status = begin_rows(&e, c, mask, display, p);
    c->some.stored = mem_zeroed((size_t)e.height, sizeof *c->some.stored);
    if (!status && !c->some.stored)
        status = RELUME_ENOMEM;
    if (!status)
        coefficients_choose_steps(c, e.total, mask->data != NULL, p->step);
    if (!status && relume_storage_top(c->info.storage))
        status = measure_storage(c->some.stored, c, &e);
    for (int y = c->some.row; !status && y < c->some.row + c->some.rows; y++)
        status = c->some.stored[y].status;
    end_rows(&e);
    return status;
}

struct relume_fidelity project_rows_fidelity(const struct project_rows *all, int height, int lights)
{
    struct relume_fidelity report = {0};
    struct encoding e = {
        .height = height,
        .lights = lights,
        .row_error = all->error,
        .shown_error = all->shown_error,
        .root_sum = all->root_sum,
        .error_count = all->error_count,
        .lit_count = all->lit_count,
    };
    (void)!fill_report(&report, &e, all->stored);  // rows that could not be read have been noticed
    return report;
}

// ---------------------------------------------------------------- other coefficients

// The rows of `values` in a band that are looked at.
static void take_values(struct encoding *e, const struct encode_values *values)
{
    const size_t pixels = (size_t)e->rows * (size_t)e->width;
    for (int y = 0; y < e->rows; y++)
        if (is_looked_at(e, e->row + y))
            values->row(values->user, e->row + y, e->values + (size_t)y * (size_t)e->width, pixels);
}

// So that some hundred thousand pixels of a view are judged, or all of a smaller one.
static int rows_apart(size_t pixels)
{
    enum { ENOUGH = 400000, MOST_APART = 8 };
    int apart = 1;
    while (apart < MOST_APART && pixels / (2 * (size_t)apart) >= ENOUGH)
        apart *= 2;
    return apart;
}

// To read the images from `row` on, and to compare them.
static relume_status begin_judging(struct encoding *e, relume_coefficients *c,
                                   const relume_capture *capture, int view,
                                   const struct encode_tiles *tiles, bool own,
                                   const struct relume_project_params *p)
{
    relume_status status = begin(e, c->info.coder, capture, view, p);
    e->out = c;
    if (tiles) {
        const int last = (tiles->end - 1) / tiles->across * tiles->side;
        e->row = tiles->first / tiles->across * tiles->side;
        e->end = last + tiles->side < e->height ? last + tiles->side : e->height;
        e->run = tiles->side < PIECE ? tiles->side : PIECE;
        e->shown_only = true;
        e->apart = rows_apart((size_t)e->width * (size_t)e->height);
    }
    if (!status)
        status = alloc_encoder(e, capture);
    if (!status && own) {
        e->truth = mem_array((size_t)e->planes * BAND_ROWS, (size_t)e->width * sizeof *e->truth);
        return e->truth ? RELUME_OK : RELUME_ENOMEM;
    }
    if (!status)
        status = open_table(e, capture, view, p);
    return status ? status : relume_table_skip(e->table, e->row);
}

static void end_judging(struct encoding *e)
{
    near_fit_destroy(&e->near);
    relume_table_destroy(&e->table);
    free_encoder(e);
}

relume_status encode_judge(double *psnr_db, relume_coefficients *c, const relume_capture *capture,
                           int view, const struct encode_values *values,
                           const struct relume_project_params *p)
{
    struct encoding e;
    relume_status status = begin_judging(&e, c, capture, view, NULL, values->own, p);
    for (; !status && e.row < e.end; e.row += BAND_ROWS) {
        status = read_band(&e);
        if (!status) {
            take_values(&e, values);
            measure_band(&e);
        }
        if (!status && !say_done(&e, capture, view, "measuring", p->log))
            status = RELUME_ECANCEL;
    }
    *psnr_db = status ? 0.0 : shown_psnr(&e);
    end_judging(&e);
    return status;
}

// Which runs of a band are of the tiles.
static void choose_runs(struct encoding *e, const struct encode_tiles *t)
{
    const int before = e->row / t->side * t->across, each = t->side / e->run, most = runs_of(e);
    const int first = t->first > before ? t->first - before : 0;
    const int end = t->end < before + t->across ? t->end - before : t->across;
    e->first_run = first * each;
    e->runs = (end * each < most ? end * each : most) - e->first_run;
}

// The sums of a band join those of its tiles, row by row from left to right.
static void add_runs(struct encode_square *out, const struct encoding *e,
                     const struct encode_tiles *t, size_t items)
{
    const size_t lights = (size_t)e->lights;
    for (size_t k = 0; k < items; k++) {
        const int run = e->first_run + (int)(k % (size_t)e->runs);
        const int tile = e->row / t->side * t->across + run * e->run / t->side;
        struct encode_square *to = &out[tile - t->first];
        for (size_t i = 0; i < lights; i++)
            to->sum += e->shown[k * lights + i];
        to->count += e->sums[k].count;
    }
}

relume_status encode_judge_tiles(struct encode_square *out, relume_coefficients *c,
                                 const relume_capture *capture, int view,
                                 const struct encode_tiles *tiles,
                                 const struct encode_values *values,
                                 const struct relume_project_params *p)
{
    struct encoding e;
    memset(out, 0, (size_t)(tiles->end - tiles->first) * sizeof *out);
    relume_status status = begin_judging(&e, c, capture, view, tiles, values->own, p);
    for (; !status && e.row < e.end; e.row += BAND_ROWS) {
        status = read_band(&e);
        if (!status) {
            choose_runs(&e, tiles);
            take_values(&e, values);
            add_runs(out, &e, tiles, measure_runs(&e));
        }
        if (!status && !say_done(&e, capture, view, "measuring", p->log))
            status = RELUME_ECANCEL;
    }
    end_judging(&e);
    return status;
}
