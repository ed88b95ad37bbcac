// planes.c - the planes of a plan as numbers for every pixel, in scratch space on disk
#include "exchange/foreign/planes.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/scratch.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"
#include "core/math/scalar.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <string.h>

enum { BAND_ROWS = 8, BLOCK = 8 };

static relume_status allocate(struct planes *p, int width, int height, int count, const char *near,
                              const struct relume_log *log)
{
    *p = (struct planes){.width = width, .height = height, .count = count};
    const size_t size = (size_t)width * (size_t)height * (size_t)count * sizeof *p->data;
    p->minimum = mem_zeroed((size_t)count, sizeof *p->minimum);
    p->maximum = mem_zeroed((size_t)count, sizeof *p->maximum);
    if (!p->minimum || !p->maximum)
        return RELUME_ENOMEM;
    p->data = scratch_map(near, size);
    if (p->data)
        return RELUME_OK;
    return errno == ENOMEM
               ? RELUME_ENOMEM
               : log_fail(log, RELUME_EIO,
                          "%s: no temporary file of %zu bytes can be made beside it; %s",
                          near ? near : "$TMPDIR", size, strerror(errno));
}

void planes_free(struct planes *p)
{
    scratch_unmap(p->data,
                  (size_t)p->width * (size_t)p->height * (size_t)p->count * sizeof *p->data);
    mem_free(p->minimum);
    mem_free(p->maximum);
    *p = (struct planes){0};
}

struct maker {
    struct planes *out;
    const struct plan *plan;
    const struct source *s;
    float *map;             // [planes][P]
    relume_status *status;  // [bands]
};

// Luminance forms: the terms become relative to the colour.
static void divide_by_colour(const struct plan *plan, float *c, size_t n)
{
    const size_t k = (size_t)plan->terms;
    for (size_t i = 0; i < n; i++) {
        float sum = 0.0f;
        for (size_t j = k; j < k + 3; j++) {
            c[j * n + i] = fminf(fmaxf(c[j * n + i], 0.0f), 1.0f);
            sum += c[j * n + i];
        }
        for (size_t j = 0; j < k; j++)
            c[j * n + i] = sum > 1.0f / 255.0f ? c[j * n + i] / sum : 0.0f;
    }
}

static void make_band(void *context, size_t item, int worker)
{
    (void)worker;
    const struct maker *m = context;
    const struct plan *plan = m->plan;
    const int row = (int)item * BAND_ROWS;
    const int rows = m->s->height - row < BAND_ROWS ? m->s->height - row : BAND_ROWS;
    const size_t n = (size_t)rows * (size_t)m->s->width;
    const size_t pixels = (size_t)m->s->width * (size_t)m->s->height;
    float *x = mem_array((size_t)plan->numbers * n, sizeof *x);
    float *c = mem_array((size_t)plan->planes * n, sizeof *c);
    m->status[item] = x && c ? source_rows(m->s, row, rows, x) : RELUME_ENOMEM;
    if (!m->status[item]) {
        lsq_multiply(plan->planes, (int)n, plan->numbers, m->map, plan->numbers, x, (int)n, c,
                     (int)n);
        for (size_t p = 0; p < (size_t)plan->planes; p++)
            for (size_t i = 0; i < n; i++)
                c[p * n + i] += (float)plan->shift[p];
        if (plan->form == FOREIGN_LUMINANCE)
            divide_by_colour(plan, c, n);
        for (size_t p = 0; p < (size_t)plan->planes; p++)
            memcpy(m->out->data + p * pixels + (size_t)row * (size_t)m->s->width, c + p * n,
                   n * sizeof *c);
    }
    mem_free(x);
    mem_free(c);
}

static void find_range(void *context, size_t item, int worker)
{
    (void)worker;
    struct planes *p = context;
    const float *v = planes_at(p, (int)item);
    float min = FLT_MAX, max = -FLT_MAX;
    for (size_t i = 0; i < (size_t)p->width * (size_t)p->height; i++) {
        min = v[i] < min ? v[i] : min;
        max = v[i] > max ? v[i] : max;
    }
    p->minimum[item] = (double)min;
    p->maximum[item] = (double)max;
}

relume_status planes_make(struct planes *out, const struct plan *plan, const struct source *s,
                          const char *near, int threads)
{
    const size_t bands = (size_t)((s->height + BAND_ROWS - 1) / BAND_ROWS);
    const size_t entries = (size_t)plan->planes * (size_t)plan->numbers;
    struct maker m = {.out = out, .plan = plan, .s = s};
    relume_status status = allocate(out, s->width, s->height, plan->planes, near, s->log);
    m.map = mem_array(entries, sizeof *m.map);
    m.status = mem_zeroed(bands, sizeof *m.status);
    if (!status && (!m.map || !m.status))
        status = RELUME_ENOMEM;
    for (size_t i = 0; !status && i < entries; i++)
        m.map[i] = (float)plan->map[i];
    if (!status)
        thread_for(threads, bands, make_band, &m);
    for (size_t i = 0; !status && i < bands; i++)
        status = m.status[i];
    if (!status)
        thread_for(threads, (size_t)plan->planes, find_range, out);
    mem_free(m.map);
    mem_free(m.status);
    if (status)
        planes_free(out);
    return status;
}

relume_status planes_sample(struct planes *out, const struct planes *p, int every, const char *near,
                            const struct relume_log *log)
{
    const int blocks = p->height / BLOCK, kept = (blocks + every - 1) / every;
    const int rows = every == 1 ? p->height : kept * BLOCK;
    const size_t row = (size_t)p->width;
    relume_status status = allocate(out, p->width, rows, p->count, near, log);
    for (int i = 0; !status && i < p->count; i++) {
        float *to = out->data + (size_t)i * (size_t)rows * row;
        for (int y = 0; y < rows; y++)
            memcpy(to + (size_t)y * row,
                   planes_at(p, i) + (size_t)(y / BLOCK * every * BLOCK + y % BLOCK) * row,
                   row * sizeof *to);
        out->minimum[i] = p->minimum[i];
        out->maximum[i] = p->maximum[i];
    }
    if (status)
        planes_free(out);
    return status;
}

float *plane_halved(const float *from, int width, int height)
{
    const int w = (width + 1) / 2, h = (height + 1) / 2;
    float *to = mem_array((size_t)w * (size_t)h, sizeof *to);
    for (int y = 0; to && y < h; y++)
        for (int x = 0; x < w; x++) {
            const int right = smaller_of(2 * x + 1, width - 1),
                      below = smaller_of(2 * y + 1, height - 1);
            const float *a = from + (size_t)(2 * y) * (size_t)width;
            const float *b = from + (size_t)below * (size_t)width;
            to[(size_t)y * (size_t)w + (size_t)x] =
                0.25f * (a[2 * x] + a[right] + b[2 * x] + b[right]);
        }
    return to;
}
