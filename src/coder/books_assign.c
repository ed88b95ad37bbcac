// books_assign.c - every pixel of a view becomes one index per book
//
// Contours (Wong 1998, Fig 9-11) arise where a smooth ramp crosses from one code to the next. With
// `dither` a pixel's error is handed on to the three pixels below it (1/4, 1/2, 1/4; Floyd and
// Steinberg 1976 without the pixel beside, so that a row is still searched in one go), and the
// ramp's mean value comes out right at the price of noise.
#include "coder/books.h"

#include "base/log.h"
#include "base/memory.h"
#include "base/thread.h"
#include "coder/basis.h"
#include "coder/coefficients.h"

#include <math.h>
#include <string.h>

// An error larger than this many times the usual one is an outlier, which must not smear.
static const double MOST_HANDED_ON = 2.0;

struct work {
    uint16_t *waiting;
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
    struct work *work;  // [workers]
    double *loss;       // [height]: squared error over the captured lights; negative: not measured
    float *carried;     // dither: [x][planes], for the row in progress
    float dither;
    relume_status status;
};

static void free_work(struct work *w)
{
    free(w->waiting);
    free(w->row);
    free(w->residual);
    free(w->part);
    free(w->scratch);
    free(w->distance);
    free(w->apart);
    free(w->which);
    free(w->wanted);
    free(w->kept);
}

static bool alloc_work(struct work *w, const struct assignment *a)
{
    const size_t width = (size_t)a->view->info.width, size = width * (size_t)a->books->info.planes;
    const size_t lights = (size_t)relume_coder_info(a->view->info.coder)->lights;
    size_t scratch = 0;
    for (int b = 0; b < a->books->info.books; b++) {
        const size_t s = nearest_scratch(&a->books->own[b].nearest);
        scratch = s > scratch ? s : scratch;
    }
    w->waiting = mem_array(size, sizeof *w->waiting);
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

// Coefficients of the row, with what the row above has handed on.
static relume_status begin_row(const struct assignment *a, struct work *w, int y)
{
    const size_t width = (size_t)a->view->info.width, planes = (size_t)a->books->info.planes;
    const relume_status status = coefficients_values(a->view, y, w->waiting, w->row);
    for (size_t x = 0; !status && x < width; x++)
        for (size_t p = 0; p < planes; p++)
            w->residual[x * planes + p] =
                w->row[p * width + x] + (a->carried ? a->carried[x * planes + p] : 0.0f);
    return status;
}

// Pixels [first, last) of the row, one book after another.
static void find_codes(const struct assignment *a, struct work *row, struct work *own, int y,
                       size_t first, size_t last)
{
    const size_t width = (size_t)a->view->info.width, planes = (size_t)a->books->info.planes;
    for (int b = 0; b < a->books->info.books; b++) {
        const struct relume_book *book = &a->books->book[b];
        uint16_t *index = a->index[b] + (size_t)y * width;
        for (size_t x = first; x < last; x++)
            book_project(row->part + x * (size_t)book->dim, book, row->residual + x * planes);
        nearest_find(&a->books->own[b].nearest, row->part, row->which + first, last - first, index,
                     row->distance, row->apart, own->scratch);
        for (size_t x = first; x < last; x++) {
            const float *v = a->books->vectors[b] + (size_t)index[x] * planes;
            for (size_t p = 0; p < planes; p++)
                row->residual[x * planes + p] -= v[p];
        }
    }
}

// What the row's indices say instead of its coefficients, over the captured lights.
static double measure_row(const struct assignment *a, struct work *w, int y)
{
    const size_t width = (size_t)a->view->info.width, planes = (size_t)a->books->info.planes;
    const relume_coder *coder = a->view->info.coder;
    const size_t n = (size_t)relume_coder_info(coder)->lights * width;
    float *kept = w->part;
    memset(kept, 0, width * planes * sizeof *kept);
    for (int b = 0; b < a->books->info.books; b++)
        for (size_t x = 0; x < width; x++) {
            const size_t code = a->index[b][(size_t)y * width + x];
            for (size_t p = 0; p < planes; p++)
                kept[p * width + x] += a->books->vectors[b][code * planes + p];
        }
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

static bool is_measured(const struct assignment *a, int y)
{
    return y % (a->view->bands < 64 ? BAND_ROWS : 4 * BAND_ROWS) == 0;
}

static void assign_row(void *context, size_t item, int worker)
{
    struct assignment *a = context;
    struct work *w = &a->work[worker];
    const int y = (int)item;
    a->loss[y] = -1.0;
    if (begin_row(a, w, y)) {
        a->loss[y] = NAN;
        return;
    }
    find_codes(a, w, w, y, 0, (size_t)a->view->info.width);
    if (is_measured(a, y))
        a->loss[y] = measure_row(a, w, y);
}

// ---------------------------------------------------------------- dither

enum { RUN = 192 };  // pixels of a row that a worker takes

struct dithering {
    struct assignment *a;
    int y;
};

static void assign_run(void *context, size_t item, int worker)
{
    const struct dithering *d = context;
    const size_t width = (size_t)d->a->view->info.width, first = item * RUN;
    find_codes(d->a, &d->a->work[0], &d->a->work[worker], d->y, first,
               first + RUN < width ? first + RUN : width);
}

static void hand_on(struct assignment *a)
{
    const size_t width = (size_t)a->view->info.width, planes = (size_t)a->books->info.planes;
    const double usual = a->books->own[a->books->info.books - 1].error;
    const float *error = a->work[0].residual;
    memset(a->carried, 0, width * planes * sizeof *a->carried);
    for (size_t x = 0; x < width; x++, error += planes) {
        double square = 0.0;
        for (size_t p = 0; p < planes; p++)
            square += (double)error[p] * (double)error[p];
        if (!(square > 0.0))
            continue;
        const double most = MOST_HANDED_ON * MOST_HANDED_ON * usual;
        const float part = a->dither * (float)(square > most ? sqrt(most / square) : 1.0);
        for (int side = -1; side <= 1; side++) {
            if ((side < 0 && x == 0) || (side > 0 && x + 1 == width))
                continue;
            float *to = a->carried + (size_t)((ptrdiff_t)x + side) * planes;
            const float share = part * (side ? 0.25f : 0.5f);
            for (size_t p = 0; p < planes; p++)
                to[p] += share * error[p];
        }
    }
}

static relume_status assign_dithered(struct assignment *a, int threads,
                                     const struct relume_log *log)
{
    const size_t width = (size_t)a->view->info.width;
    const int height = a->view->info.height;
    struct dithering d = {.a = a};
    for (d.y = 0; d.y < height; d.y++) {
        const relume_status status = begin_row(a, &a->work[0], d.y);
        if (status)
            return status;
        thread_for(threads, (width + RUN - 1) / RUN, assign_run, &d);
        hand_on(a);
        a->loss[d.y] = is_measured(a, d.y) ? measure_row(a, &a->work[0], d.y) : -1.0;
        if (!log_progress(log, "finding codes", (d.y + 1.0) / height))
            return RELUME_ECANCEL;
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- interface

static relume_status assign_plain(struct assignment *a, int threads, const struct relume_log *log)
{
    const int height = a->view->info.height;
    thread_for(threads, (size_t)height, assign_row, a);
    for (int y = 0; y < height; y++)
        if (isnan(a->loss[y]))
            return RELUME_EIO;
    return log_progress(log, "finding codes", 1.0) ? RELUME_OK : RELUME_ECANCEL;
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
    const struct relume_books_params p = params ? *params : (struct relume_books_params){0};
    const int workers = thread_count(p.threads);
    struct assignment a = {
        .books = books,
        .view = view,
        .index = index,
        .work = mem_zeroed((size_t)workers, sizeof *a.work),
        .loss = mem_array((size_t)view->info.height, sizeof *a.loss),
        .dither = p.dither,
    };
    const relume_coder *coder = view->info.coder;
    relume_status status =
        a.work && a.loss ? captured_create(&a.captured, coder, coder->world, coder->info.lights)
                         : RELUME_ENOMEM;
    for (int i = 0; !status && i < workers; i++)
        status = alloc_work(&a.work[i], &a) ? RELUME_OK : RELUME_ENOMEM;
    if (!status && p.dither > 0.0f) {
        a.carried =
            mem_zeroed((size_t)view->info.width * (size_t)books->info.planes, sizeof *a.carried);
        status = a.carried ? assign_dithered(&a, p.threads, p.log) : RELUME_ENOMEM;
    } else if (!status) {
        status = assign_plain(&a, p.threads, p.log);
    }
    if (!status && store_rms)
        *store_rms = mean_loss(&a);
    for (int i = 0; a.work && i < workers; i++)
        free_work(&a.work[i]);
    captured_destroy(&a.captured);
    free(a.work);
    free(a.loss);
    free(a.carried);
    return status;
}
