// heldout_books.c - coefficients in memory as codebooks would keep them
#include "core/base/memory.h"
#include "core/base/scratch.h"
#include "encode/choose/heldout.h"
#include "format/codebook/books.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"

#include <string.h>

void fold_books_drop(struct fold_books *b)
{
    for (int v = 0; v < b->views; v++) {
        if (b->books)
            relume_books_destroy(&b->books[v]);
        for (int i = 0; b->index && i < RELUME_MOST_BOOKS; i++)
            mem_free(b->index[v * RELUME_MOST_BOOKS + i]);
    }
    mem_free(b->books);
    mem_free(b->index);
    mem_free(b->first);
    *b = (struct fold_books){0};
}

int heldout_rows(const relume_heldout *h, int view, size_t *first)
{
    int rows = 0;
    for (int i = h->strips - 1; i >= 0; i--)
        if (h->strip[i].view == view) {
            rows += h->strip[i].rows;
            *first = h->strip[i].first;
        }
    return rows;
}

// One band of rows as it waits in a scratch file (coefficients.h).
static relume_status keep_band(relume_coefficients *c, int row, const float *value, size_t stride,
                               void *packed)
{
    const size_t width = (size_t)c->info.width, planes = (size_t)c->info.planes;
    const size_t rows =
        (size_t)(c->info.height - row < BAND_ROWS ? c->info.height - row : BAND_ROWS);
    const size_t size = width * coefficients_waiting(c);
    for (size_t p = 0; p < planes; p++) {
        const float *v = value + p * stride;
        c->band[(size_t)(row / BAND_ROWS) * planes + p] = range_settle(range_of(v, rows * width));
        for (size_t y = 0; y < rows; y++)
            coefficients_wait(c, (int)p, row, v + y * width, width,
                              (char *)packed + (y * planes + p) * size);
    }
    return scratch_write(c->fd, packed, rows * planes * width * coefficients_waiting(c),
                         coefficients_offset(c, row))
               ? RELUME_OK
               : RELUME_EIO;
}

static relume_status keep_view(relume_coefficients **out, const relume_heldout *h,
                               const relume_coder *coder, int view, const float *value,
                               const struct relume_heldout_store *store, size_t *first)
{
    const int rows = heldout_rows(h, view, first);
    const size_t width = (size_t)h->width, planes = (size_t)relume_coder_info(coder)->planes;
    void *packed = mem_array(planes * BAND_ROWS * width, sizeof(float));
    relume_status status = packed ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = coefficients_create(
            out, coder, h->width, rows,
            relume_project_params(.log = h->params.log, .storage = store->storage));
    for (int row = 0; !status && row < rows; row += BAND_ROWS)
        status = keep_band(*out, row, value + *first + (size_t)row * width, h->pixels, packed);
    mem_free(packed);
    return status;
}

static relume_status assign(struct fold_books *b, int view, const relume_coefficients *c,
                            const struct relume_books_params *p)
{
    const relume_books *books = b->books[b->share ? 0 : view];
    uint16_t **index = b->index + view * RELUME_MOST_BOOKS;
    const size_t pixels = (size_t)c->info.width * (size_t)c->info.height;
    for (int i = 0; i < relume_books_info(books)->books; i++)
        if (!(index[i] = mem_array(pixels, sizeof **index)))
            return RELUME_ENOMEM;
    return relume_books_assign(index, NULL, books, c, p);
}

static relume_status learn(struct fold_books *b, relume_coefficients **kept,
                           const struct relume_books_params *p)
{
    relume_status status = RELUME_OK;
    for (int v = 0; !status && v < b->views; v++) {
        if (v == 0 || !b->share)
            status = relume_books_train(&b->books[v], (const relume_coefficients *const *)kept + v,
                                        b->share ? b->views : 1, p);
        if (!status)
            status = assign(b, v, kept[v], p);
    }
    return status;
}

relume_status fold_books_make(struct fold_books *out, const relume_heldout *h,
                              const relume_coder *coder, const float *value,
                              const struct relume_heldout_store *store)
{
    const size_t views = (size_t)h->views;
    struct relume_books_params p = *store->books;
    *out = (struct fold_books){.views = h->views, .share = store->share};
    out->books = mem_zeroed(views, sizeof *out->books);
    out->index = mem_zeroed(views * RELUME_MOST_BOOKS, sizeof *out->index);
    out->first = mem_zeroed(views, sizeof *out->first);
    relume_coefficients **kept = mem_zeroed(views, sizeof *kept);
    relume_status status =
        out->books && out->index && out->first && kept ? RELUME_OK : RELUME_ENOMEM;
    for (int v = 0; !status && v < h->views; v++)
        status = keep_view(&kept[v], h, coder, v, value, store, &out->first[v]);
    p.threads = h->params.threads;
    if (!status)
        status = learn(out, kept, &p);
    for (int v = 0; kept && v < h->views; v++)
        relume_coefficients_destroy(&kept[v]);
    mem_free(kept);
    return status;
}

void fold_books_restore(const struct fold_books *b, int view, size_t first, size_t n, float *to)
{
    const struct relume_books_info *info = relume_books_info(b->books[b->share ? 0 : view]);
    const size_t planes = (size_t)info->planes, from = first - b->first[view];
    memset(to, 0, planes * n * sizeof *to);
    for (int i = 0; i < info->books; i++) {
        const uint16_t *index = b->index[view * RELUME_MOST_BOOKS + i] + from;
        for (size_t x = 0; x < n; x++) {
            const float *vector = info->vectors[i] + (size_t)index[x] * planes;
            for (size_t p = 0; p < planes; p++)
                to[p * n + x] += vector[p];
        }
    }
}
