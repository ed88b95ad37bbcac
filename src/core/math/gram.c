// gram.c - Gram matrices of many rows, summed on several cores
#include "core/math/gram.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"

#include <string.h>

enum { BATCH = 512, MOST_PARTS = 16, MOST_BYTES = 1 << 26 };

struct sum {
    size_t n, count, parts;
    void (*fill)(const void *context, size_t first, size_t rows, double *out);
    const void *context;
    double *part;  // [parts][n][n]
    double *rows;  // [workers][BATCH][n]
};

// Part `item` is a run of whole batches.
static void sum_part(void *context, size_t item, int worker)
{
    const struct sum *s = context;
    const size_t batches = (s->count + BATCH - 1) / BATCH;
    const size_t end = (item + 1) * batches / s->parts;
    double *rows = s->rows + (size_t)worker * BATCH * s->n;
    for (size_t b = item * batches / s->parts; b < end; b++) {
        const size_t left = s->count - b * BATCH, rest = left < BATCH ? left : BATCH;
        s->fill(s->context, b * BATCH, rest, rows);
        lsq_add_gram(s->part + item * s->n * s->n, (int)s->n, rows, (int)rest);
    }
}

relume_status gram_sum(double *gram, size_t n, size_t count,
                       void (*fill)(const void *context, size_t first, size_t rows, double *out),
                       const void *context, int threads)
{
    const size_t fit = MOST_BYTES / (n * n * sizeof *gram);
    struct sum s = {.n = n, .count = count, .fill = fill, .context = context};
    s.parts = fit < 1 ? 1 : fit < MOST_PARTS ? fit : MOST_PARTS;
    s.part = mem_zeroed(s.parts * n, n * sizeof *s.part);
    s.rows = mem_array((size_t)thread_count(threads) * BATCH, n * sizeof *s.rows);
    const bool good = s.part && s.rows;
    if (good) {
        thread_for(threads, s.parts, sum_part, &s);
        memset(gram, 0, n * n * sizeof *gram);
        for (size_t p = 0; p < s.parts; p++)
            for (size_t i = 0; i < n * n; i++)
                gram[i] += s.part[p * n * n + i];
    }
    mem_free(s.part);
    mem_free(s.rows);
    return good ? RELUME_OK : RELUME_ENOMEM;
}
