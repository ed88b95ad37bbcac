// aperture.c - an eye's aperture as a picture of transmittance
#include "relight/eye/aperture.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/fnv.h"
#include "relight/eye/pupil.h"

#include <math.h>
#include <string.h>

enum { BAND = 16 };  // rows that one thread draws at a time

// ---------------------------------------------------------------- coverage of one row

// Sums of spans as differences: the running sum of `d` is the coverage of each texel.
struct row {
    float *d;  // [n + 2], zero between uses
    int n;
    int first, last;  // texels touched, first > last: none
};

static void add_span(struct row *row, double a, double b, float weight)
{
    a = a > 0.0 ? a : 0.0;
    b = b < row->n ? b : row->n;
    if (!(a < b))
        return;
    const int i = relume_whole(a), j = relume_whole(b);
    const float left = (float)(a - i) * weight, right = (float)(b - j) * weight;
    row->d[i] += weight - left;
    row->d[i + 1] += left;
    row->d[j] -= weight - right;
    row->d[j + 1] -= right;
    row->first = i < row->first ? i : row->first;
    row->last = j > row->last ? j : row->last;
}

static void begin(struct row *row)
{
    row->first = row->n;
    row->last = -1;
}

// t *= 1 - opacity coverage, and the differences are zero again.
static void block(struct row *row, float *t, float opacity)
{
    float sum = 0.0f;
    const int last = row->last < row->n ? row->last : row->n - 1;
    for (int i = row->first; i <= last; i++) {
        sum += row->d[i];
        t[i] *= 1.0f - opacity * sum;
        row->d[i] = 0.0f;
    }
    for (int i = last + 1; i <= row->last + 1; i++)
        row->d[i] = 0.0f;
}

// t *= coverage from texel 0 to n; returns the sum of coverages.
static double admit(struct row *row, float *t)
{
    float sum = 0.0f;
    double light = 0.0;
    const int last = row->last < row->n ? row->last : row->n - 1;
    for (int i = 0; i < row->first && i < row->n; i++)
        t[i] = 0.0f;
    for (int i = row->first; i <= last; i++) {
        sum += row->d[i];
        t[i] *= sum > 0.0f ? sum : 0.0f;
        light += t[i];
        row->d[i] = 0.0f;
    }
    for (int i = last + 1; i < row->n; i++)
        t[i] = 0.0f;
    for (int i = last + 1; i <= row->last + 1; i++)
        row->d[i] = 0.0f;
    return light;
}

// ---------------------------------------------------------------- primitives, in texels

// Scan lines per row for something of that size: its ends and slopes stay smooth.
static int lines_for(double texels)
{
    return texels > 8.0 ? 4 : (int)fmin(ceil(4.0 + 8.0 / fmax(texels, 0.25)), 24.0);
}

static void disc_row(struct row *row, double x, double y, double radius, int top, int lines)
{
    for (int k = 0; k < lines; k++) {
        const double dy = top + (k + 0.5) / lines - y, rest = radius * radius - dy * dy;
        if (rest <= 0.0)
            continue;
        const double half = sqrt(rest);
        add_span(row, x - half, x + half, 1.0f / (float)lines);
    }
}

// A stroke as four half planes a x + b y <= c.
struct quad {
    double a[4], b[4], c[4];
    double y0, y1;
    int lines;
};

static struct quad quad_of(const double x[2], const double y[2], const double width[2])
{
    struct quad q = {.y0 = INFINITY, .y1 = -INFINITY};
    const double l = hypot(x[1] - x[0], y[1] - y[0]);
    const double ux = l > 0.0 ? (x[1] - x[0]) / l : 1.0, uy = l > 0.0 ? (y[1] - y[0]) / l : 0.0;
    double px[4], py[4];
    for (int i = 0; i < 4; i++) {  // corners in order around
        const int end = i == 1 || i == 2;
        const double side = i < 2 ? 0.5 : -0.5;
        px[i] = x[end] - uy * side * width[end];
        py[i] = y[end] + ux * side * width[end];
        q.y0 = fmin(q.y0, py[i]);
        q.y1 = fmax(q.y1, py[i]);
    }
    for (int i = 0; i < 4; i++) {
        const int j = (i + 1) % 4;
        q.a[i] = py[i] - py[j];
        q.b[i] = px[j] - px[i];
        q.c[i] = q.a[i] * px[i] + q.b[i] * py[i];
    }
    q.lines = lines_for(fmin(fmin(width[0], width[1]), l));
    return q;
}

static void quad_row(struct row *row, const struct quad *q, int top)
{
    for (int k = 0; k < q->lines; k++) {
        const double y = top + (k + 0.5) / q->lines;
        double from = -INFINITY, to = INFINITY;
        for (int i = 0; i < 4; i++) {
            const double rest = q->c[i] - q->b[i] * y;
            if (q->a[i] > 0.0)
                to = fmin(to, rest / q->a[i]);
            else if (q->a[i] < 0.0)
                from = fmax(from, rest / q->a[i]);
            else if (rest < 0.0)
                to = -INFINITY;
        }
        if (from < to)
            add_span(row, from, to, 1.0f / (float)q->lines);
    }
}

// ---------------------------------------------------------------- bands

struct drawing {
    struct canvas *canvas;
    const struct relume_aperture *aperture;
    unsigned parts_off;
    float *t;  // where strokes and discs go
    const struct relume_eye_disc *discs;
    int count;
    double scale;
    const struct relume_eye_stroke *strokes;
    int stroke_count;
    int from, to;
    float *differences;  // [threads][n + 4]
    double (*light)[2];  // [bands]: of the pupil without and with lids
};

static struct row row_of(const struct drawing *d, int worker)
{
    const size_t n = (size_t)d->canvas->n;
    return (struct row){d->differences + (size_t)worker * (n + 4), (int)n, (int)n, -1};
}

// The axis, in texels from the left and from the top: the middle of texel n / 2.
static double middle_of(const struct canvas *c)
{
    return 0.5 * c->n + 0.5;
}

static double texel(const struct canvas *c, double mm)
{
    return mm / c->texel_mm;
}

static void draw_discs(const struct drawing *d, struct row *row, int from, int to)
{
    const struct canvas *const c = d->canvas;
    const double middle = middle_of(c);
    for (int i = 0; i < d->count; i++) {
        const double x = middle + texel(c, d->scale * (double)d->discs[i].x);
        const double y = middle - texel(c, d->scale * (double)d->discs[i].y);
        const double radius = texel(c, d->scale * (double)d->discs[i].radius);
        const int lines = lines_for(radius);
        const int first = relume_whole(fmax(floor(y - radius), from));
        const int last = relume_whole(fmin(floor(y + radius), to - 1));
        if (x + radius < 0.0 || x - radius > c->n)
            continue;
        for (int top = first; top <= last; top++) {
            begin(row);
            disc_row(row, x, y, radius, top, lines);
            block(row, d->t + (size_t)top * (size_t)c->n, d->discs[i].opacity);
        }
    }
}

static void draw_strokes(const struct drawing *d, struct row *row, int from, int to)
{
    const struct canvas *const c = d->canvas;
    const double middle = middle_of(c);
    for (int i = 0; i < d->stroke_count; i++) {
        const struct relume_eye_stroke *const s = &d->strokes[i];
        const double x[2] = {middle + texel(c, (double)s->x[0]),
                             middle + texel(c, (double)s->x[1])};
        const double y[2] = {middle - texel(c, (double)s->y[0]),
                             middle - texel(c, (double)s->y[1])};
        const double w[2] = {texel(c, (double)s->width[0]), texel(c, (double)s->width[1])};
        const double reach = 0.5 * fmax(w[0], w[1]);
        if (fmin(y[0], y[1]) - reach >= to || fmax(y[0], y[1]) + reach < from)
            continue;
        const struct quad q = quad_of(x, y, w);
        const int first = relume_whole(fmax(floor(q.y0), from)),
                  last = relume_whole(fmin(floor(q.y1), to - 1));
        for (int top = first; top <= last; top++) {
            begin(row);
            quad_row(row, &q, top);
            block(row, d->t + (size_t)top * (size_t)c->n, s->opacity);
        }
    }
}

static void band_of(const struct drawing *d, size_t item, int *from, int *to)
{
    *from = d->from + (int)item * BAND;
    *to = *from + BAND < d->to ? *from + BAND : d->to;
}

static size_t bands(const struct drawing *d)
{
    return d->to > d->from ? ((size_t)(d->to - d->from) + BAND - 1) / BAND : 0;
}

static void draw_band(void *context, size_t item, int worker)
{
    const struct drawing *d = context;
    struct row row = row_of(d, worker);
    int from, to;
    band_of(d, item, &from, &to);
    draw_strokes(d, &row, from, to);
    draw_discs(d, &row, from, to);
}

// ---------------------------------------------------------------- pupil and lids

static const int edge_lines = 16;

// The pupil within the lids, on the scan lines of one row.
static void opening_row(const struct drawing *d, struct row *row, int top, bool lids)
{
    const struct canvas *const c = d->canvas;
    const struct relume_aperture *const a = d->aperture;
    const double middle = middle_of(c);
    const double radius = (double)a->pupil_radius;
    for (int k = 0; k < edge_lines; k++) {
        const double y = (middle - top - (k + 0.5) / edge_lines) * c->texel_mm;
        const double rest = radius * radius - y * y;
        if (rest <= 0.0)
            continue;
        double half = sqrt(rest);
        // Edges of open eyes bend towards each other: the open part is |x| below a bound.
        const double above = (y - (double)a->upper[0]) / (double)a->upper[1];
        const double below = (y - (double)a->lower[0]) / (double)a->lower[1];
        if (lids && (y >= (double)a->upper[0] || y <= (double)a->lower[0]))
            half = 0.0;
        else if (lids) {
            if (a->upper[1] < 0.0f)
                half = fmin(half, sqrt(fmax(above, 0.0)));
            if (a->lower[1] > 0.0f)
                half = fmin(half, sqrt(fmax(below, 0.0)));
        }
        add_span(row, middle + texel(c, -half), middle + texel(c, half), 1.0f / edge_lines);
    }
}

static void open_band(void *context, size_t item, int worker)
{
    const struct drawing *d = context;
    struct row row = row_of(d, worker);
    const struct canvas *const c = d->canvas;
    const bool lids = !(d->parts_off & RELUME_EYE_LIDS);
    int from, to;
    band_of(d, item, &from, &to);
    d->light[item][0] = d->light[item][1] = 0.0;
    for (int top = from; top < to; top++) {
        const size_t at = (size_t)top * (size_t)c->n;
        begin(&row);
        for (int i = 0; i < c->n; i++)
            c->t[at + (size_t)i] = 1.0f;
        opening_row(d, &row, top, false);
        d->light[item][0] += admit(&row, c->t + at);
        if (lids) {
            begin(&row);
            for (int i = 0; i < c->n; i++)
                c->t[at + (size_t)i] = 1.0f;
            opening_row(d, &row, top, true);
            d->light[item][1] += admit(&row, c->t + at);
        }
        if (c->fixed)
            for (int i = 0; i < c->n; i++)
                c->t[at + (size_t)i] *= c->fixed[at + (size_t)i];
    }
    draw_band(context, item, worker);
}

// ---------------------------------------------------------------- canvas

relume_status canvas_resize(struct canvas *canvas, int n, double texel_mm)
{
    if (canvas->n == n && canvas->texel_mm == texel_mm && canvas->t)
        return RELUME_OK;
    canvas_destroy(canvas);
    *canvas = (struct canvas){.n = n, .texel_mm = texel_mm};
    canvas->t = mem_zeroed((size_t)n * (size_t)n, sizeof *canvas->t);
    return canvas->t ? RELUME_OK : RELUME_ENOMEM;
}

void canvas_destroy(struct canvas *canvas)
{
    mem_free(canvas->t);
    mem_free(canvas->fixed);
    *canvas = (struct canvas){0};
}

// Another eye has other fixed parts, and may stand where the last one stood in memory.
static uint64_t key_of(const struct relume_aperture *a)
{
    uint64_t key = FNV_START, word;
    const char *const parts[2] = {(const char *)(a->disc + a->cornea.first),
                                  (const char *)(a->stroke + a->fibres.first)};
    const size_t sizes[2] = {(size_t)a->cornea.count * sizeof *a->disc,
                             (size_t)a->fibres.count * sizeof *a->stroke};
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < sizes[k]; i += sizeof word) {
            word = sizes[k];
            memcpy(&word, parts[k] + i, sizes[k] - i < sizeof word ? sizes[k] - i : sizeof word);
            key = fnv_of_word(key, word);
            key ^= key >> 32;
        }
    return key;
}

static relume_status draw_fixed(struct drawing d, int threads)
{
    struct canvas *const c = d.canvas;
    const struct relume_aperture *const a = d.aperture;
    const size_t texels = (size_t)c->n * (size_t)c->n;
    if (!c->fixed)
        c->fixed = mem_array(texels, sizeof *c->fixed);
    if (!c->fixed)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < texels; i++)
        c->fixed[i] = 1.0f;
    d.t = c->fixed;
    d.from = 0;
    d.to = c->n;
    d.discs = a->disc + a->cornea.first;
    d.count = d.parts_off & RELUME_EYE_CORNEA ? 0 : a->cornea.count;
    d.strokes = a->stroke + a->fibres.first;
    d.stroke_count = d.parts_off & RELUME_EYE_FIBRES ? 0 : a->fibres.count;
    thread_for(threads, bands(&d), draw_band, &d);
    return RELUME_OK;
}

static void draw_moving(struct drawing d, int threads)
{
    struct canvas *const c = d.canvas;
    const struct relume_aperture *const a = d.aperture;
    const double middle = middle_of(c), radius = texel(c, (double)a->pupil_radius);
    d.t = c->t;
    d.from = c->from = relume_whole(fmax(floor(middle - radius), 0.0));
    d.to = c->to = relume_whole(fmin(ceil(middle + radius), c->n));
    d.discs = a->disc + a->lens.first;
    d.count = d.parts_off & RELUME_EYE_LENS ? 0 : a->lens.count;
    d.strokes = a->stroke + a->lashes.first;
    d.stroke_count = d.parts_off & RELUME_EYE_LIDS ? 0 : a->lashes.count;
    thread_for(threads, bands(&d), open_band, &d);
    if (!(d.parts_off & RELUME_EYE_VITREOUS)) {
        d.discs = a->disc + a->vitreous.first;
        d.count = a->vitreous.count;
        d.stroke_count = 0;
        thread_for(threads, bands(&d), draw_band, &d);
    }
    double pupil = 0.0, open = 0.0;
    for (size_t i = 0; i < bands(&d); i++) {
        pupil += d.light[i][0];
        open += d.light[i][1];
    }
    c->light = d.parts_off & RELUME_EYE_LIDS ? 1.0 : pupil > 0.0 ? fmin(open / pupil, 1.0) : 0.0;
}

relume_status canvas_draw(struct canvas *canvas, const struct relume_aperture *aperture,
                          unsigned parts_off, int threads)
{
    struct drawing d = {
        .canvas = canvas, .aperture = aperture, .parts_off = parts_off, .scale = 1.0};
    const size_t most_bands = (size_t)canvas->n / BAND + 1;
    d.differences =
        mem_zeroed((size_t)thread_count(threads) * ((size_t)canvas->n + 4), sizeof *d.differences);
    d.light = mem_array(most_bands, sizeof *d.light);
    relume_status status = d.differences && d.light ? RELUME_OK : RELUME_ENOMEM;
    const uint64_t key = key_of(aperture);
    if (!status && (!canvas->fixed || canvas->key != key))
        status = draw_fixed(d, threads);
    canvas->key = key;
    if (!status)
        draw_moving(d, threads);
    mem_free(d.differences);
    mem_free(d.light);
    return status;
}

relume_status canvas_discs(struct canvas *canvas, float *t, const struct relume_eye_disc *discs,
                           int count, double scale, int threads)
{
    struct drawing d = {.canvas = canvas,
                        .t = t,
                        .discs = discs,
                        .count = count,
                        .scale = scale,
                        .from = 0,
                        .to = canvas->n};
    d.differences =
        mem_zeroed((size_t)thread_count(threads) * ((size_t)canvas->n + 4), sizeof *d.differences);
    if (!d.differences)
        return RELUME_ENOMEM;
    thread_for(threads, bands(&d), draw_band, &d);
    mem_free(d.differences);
    return RELUME_OK;
}
