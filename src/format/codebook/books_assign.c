// books_assign.c - every pixel of a view becomes one index per book
#include "format/codebook/books.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "format/codebook/dither.h"
#include "format/coder/basis.h"
#include "format/coder/coding.h"
#include "format/coder/coefficients.h"

#include <math.h>
#include <string.h>

struct row_scratch {
    void *waiting;
    float *row;       // [planes][x]
    float *residual;  // [x][planes]
    float *part;      // [x][dim]
    float *scratch;
    double *distance;
    float *apart;
    uint32_t *which;
    float *wanted, *kept;  // [lights][x]
};

struct assignment {
    const relume_books *books;
    const relume_coefficients *view;
    uint16_t *const *index;
    struct captured captured;
    struct row_scratch *work;  // [workers]
    double *loss;  // [height]: squared error over the captured lights; negative: not measured
    struct dither dither[RELUME_MOST_BOOKS];  // where a book has one
    relume_status status;
};

static void free_work(struct row_scratch *w)
{
    mem_free(w->waiting);
    mem_free(w->row);
    mem_free(w->residual);
    mem_free(w->part);
    mem_free(w->scratch);
    mem_free(w->distance);
    mem_free(w->apart);
    mem_free(w->which);
    mem_free(w->wanted);
    mem_free(w->kept);
}

static bool alloc_work(struct row_scratch *w, const struct assignment *a)
{
    const size_t width = (size_t)a->view->info.width, size = width * (size_t)a->books->info.planes;
    const size_t lights = (size_t)relume_coder_info(a->view->info.coder)->lights;
    size_t scratch = 0;
    for (int b = 0; b < a->books->info.books; b++) {
        const size_t s = nearest_scratch(&a->books->own[b].nearest);
        scratch = s > scratch ? s : scratch;
    }
    w->waiting = mem_array(size, sizeof *w->row);
    w->row = mem_array(size, sizeof *w->row);
    w->residual = mem_array(size, sizeof *w->residual);
    w->part = mem_array(size, sizeof *w->part);
    w->scratch = mem_array(scratch, sizeof *w->scratch);
    w->distance = mem_array(width, sizeof *w->distance);
    w->apart = mem_array(width, sizeof *w->apart);
    w->which = mem_array(width, sizeof *w->which);
    w->wanted = mem_array(width * lights, sizeof *w->wanted);
    w->kept = mem_array(width * lights, sizeof *w->kept);
    if (!w->waiting || !w->row || !w->residual || !w->part || !w->scratch || !w->distance ||
        !w->apart || !w->which || !w->wanted || !w->kept)
        return false;
    for (size_t x = 0; x < width; x++)
        w->which[x] = (uint32_t)x;
    return true;
}

static relume_status begin_row(const struct assignment *a, struct row_scratch *w, int y)
{
    const size_t width = (size_t)a->view->info.width, planes = (size_t)a->books->info.planes;
    const relume_status status = coefficients_values(a->view, y, w->waiting, w->row);
    for (size_t x = 0; !status && x < width; x++)
        for (size_t p = 0; p < planes; p++)
            w->residual[x * planes + p] = w->row[p * width + x];
    return status;
}

// One book after another.
static void find_codes(const struct assignment *a, struct row_scratch *w, int y)
{
    const size_t width = (size_t)a->view->info.width, planes = (size_t)a->books->info.planes;
    for (int b = 0; b < a->books->info.books; b++) {
        const struct relume_book *book = &a->books->book[b];
        uint16_t *index = a->index[b] + (size_t)y * width;
        for (size_t x = 0; x < width; x++)
            book_project(w->part + x * (size_t)book->dim, book, w->residual + x * planes);
        nearest_find(&a->books->own[b].nearest, w->part, w->which, width, index, w->distance,
                     w->apart, w->scratch);
        for (size_t x = 0; x < width; x++) {
            float *residual = w->residual + x * planes;
            if (a->dither[b].other)
                dither_offer(&a->dither[b], x, (size_t)y, index[x], residual, w->row);
            const float *v = a->books->vectors[b] + (size_t)index[x] * planes;
            for (size_t p = 0; p < planes; p++)
                residual[p] -= v[p];
        }
    }
}

void books_row(float *out, size_t stride, const relume_books *books, uint16_t *const *index,
               size_t width, size_t y)
{
    const size_t planes = (size_t)books->info.planes;
    for (size_t p = 0; p < planes; p++)
        memset(out + p * stride, 0, width * sizeof *out);
    for (int b = 0; b < books->info.books; b++)
        for (size_t x = 0; x < width; x++) {
            const float *v = books->vectors[b] + index[b][y * width + x] * planes;
            for (size_t p = 0; p < planes; p++)
                out[p * stride + x] += v[p];
        }
}

// What the row's indices say instead of its coefficients, over the captured lights.
static double measure_row(const struct assignment *a, struct row_scratch *w, int y)
{
    const size_t width = (size_t)a->view->info.width;
    const relume_coder *coder = a->view->info.coder;
    const size_t n = (size_t)relume_coder_info(coder)->lights * width;
    float *kept = w->part;
    books_row(kept, width, a->books, a->index, width, (size_t)y);
    double sum = 0.0;
    for (int c = 0; c < 3; c++) {
        captured_predict(&a->captured, coder, c, w->row, width, width, w->wanted);
        captured_predict(&a->captured, coder, c, kept, width, width, w->kept);
        for (size_t i = 0; i < n; i++) {
            const double d = (double)w->wanted[i] - (double)w->kept[i];
            sum += d * d;
        }
    }
    return sum;
}

static void assign_row(void *context, size_t item, int worker)
{
    struct assignment *a = context;
    struct row_scratch *w = &a->work[worker];
    const int y = (int)item;
    a->loss[y] = -1.0;
    if (begin_row(a, w, y)) {
        a->loss[y] = NAN;
        return;
    }
    find_codes(a, w, y);
}

static void judge_row(void *context, size_t item, int worker)
{
    struct assignment *a = context;
    const int y = (int)item;
    if (y % (a->view->bands < 64 ? BAND_ROWS : 4 * BAND_ROWS) == 0)
        a->loss[y] =
            begin_row(a, &a->work[worker], y) ? (double)NAN : measure_row(a, &a->work[worker], y);
}

// Only books with none for the same planes after them: a later stage mends the contours of the
// earlier ones.
static bool is_last_stage(const struct relume_books_info *info, int book)
{
    for (int b = book + 1; b < info->books; b++)
        if (info->book[b].kind == info->book[book].kind &&
            info->book[b].first == info->book[book].first)
            return false;
    return true;
}

static relume_status prepare_dither(struct assignment *a, const struct relume_books_params *p)
{
    const struct relume_books_info *info = &a->books->info;
    const size_t width = (size_t)a->view->info.width, height = (size_t)a->view->info.height;
    relume_status status = RELUME_OK;
    for (int b = 0; !status && b < info->books; b++)
        if (is_last_stage(info, b))
            status =
                dither_open(&a->dither[b], info->vectors[b], info->codes[b], (size_t)info->planes,
                            width, height, (double)p->dither, p->threads);
    return status;
}

static relume_status spend_dither(struct assignment *a)
{
    relume_status status = RELUME_OK;
    for (int b = 0; !status && b < a->books->info.books; b++)
        if (a->dither[b].other)
            status = dither_spend(&a->dither[b], a->index[b]);
    return status;
}

// ---------------------------------------------------------------- interface

static relume_status for_rows(struct assignment *a, void (*task)(void *, size_t, int), int threads)
{
    const int height = a->view->info.height;
    thread_for(threads, (size_t)height, task, a);
    for (int y = 0; y < height; y++)
        if (isnan(a->loss[y]))
            return RELUME_EIO;
    return RELUME_OK;
}

static relume_status assign_rows(struct assignment *a, const struct relume_books_params *p)
{
    relume_status status = for_rows(a, assign_row, p->threads);
    if (!status)
        status = spend_dither(a);
    if (!status)
        status = for_rows(a, judge_row, p->threads);
    if (!status && !log_progress(p->log, "finding codes", 1.0))
        status = RELUME_ECANCEL;
    return status;
}

static double mean_loss(const struct assignment *a)
{
    const double samples =
        3.0 * a->view->info.width * relume_coder_info(a->view->info.coder)->lights;
    double sum = 0.0, rows = 0.0;
    for (int y = 0; y < a->view->info.height; y++)
        if (a->loss[y] >= 0.0) {
            sum += a->loss[y];
            rows += 1.0;
        }
    return sqrt(sum / (rows * samples));
}

relume_status relume_books_assign(uint16_t *const *index, double *store_rms,
                                  const relume_books *books, const relume_coefficients *view,
                                  const struct relume_books_params *params)
{
    const struct relume_books_params p = PARAMS_WORK(relume_books_params, params);
    const int workers = thread_count(p.threads);
    struct assignment a = {
        .books = books,
        .view = view,
        .index = index,
        .work = mem_zeroed((size_t)workers, sizeof *a.work),
        .loss = mem_array((size_t)view->info.height, sizeof *a.loss),
    };
    const relume_coder *coder = view->info.coder;
    relume_status status =
        a.work && a.loss ? captured_create(&a.captured, coder, coder->world, coder->info.lights)
                         : RELUME_ENOMEM;
    for (int i = 0; !status && i < workers; i++)
        status = alloc_work(&a.work[i], &a) ? RELUME_OK : RELUME_ENOMEM;
    if (!status && p.dither > 0.0f)
        status = prepare_dither(&a, &p);
    if (!status)
        status = assign_rows(&a, &p);
    if (!status && store_rms)
        *store_rms = mean_loss(&a);
    for (int i = 0; a.work && i < workers; i++)
        free_work(&a.work[i]);
    captured_destroy(&a.captured);
    mem_free(a.work);
    mem_free(a.loss);
    for (int b = 0; b < RELUME_MOST_BOOKS; b++)
        dither_close(&a.dither[b]);
    return status;
}
