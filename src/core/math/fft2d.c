// fft2d.c - two-dimensional transforms on the library's own threads, made of lines (fft.h)
#include "core/math/fft2d.h"

#include "core/base/memory.h"
#include "core/base/thread.h"

#include <string.h>

struct fft2d {
    int width, height, columns, threads;
    bool real;
    size_t stride;  // floats
    fft_line *row, *row_back, *column, *column_back;
    float **work;  // [threads]
};

int fft_good_size(int n)
{
    for (int size = n + n % 2;; size += 2) {
        int rest = size;
        while (rest % 2 == 0)
            rest /= 2;
        while (rest % 3 == 0)
            rest /= 3;
        while (rest % 5 == 0)
            rest /= 5;
        if (rest == 1)
            return size;
    }
}

// A block of columns before and after its transform, and the scratch of a line.
static size_t work_floats(const fft2d *f)
{
    const size_t longest = (size_t)(f->width > f->height ? f->width : f->height) + 2;
    return 4 * FFT2D_BLOCK * (size_t)f->height + 8 * longest;
}

relume_status fft2d_create(fft2d **out, int width, int height, bool real, int threads)
{
    fft2d *const f = mem_zeroed(1, sizeof *f);
    *out = NULL;
    if (!f)
        return RELUME_ENOMEM;
    *f = (fft2d){.width = width, .height = height, .real = real, .threads = thread_count(threads)};
    f->columns = real ? width / 2 + 1 : width;
    f->stride = 2 * (((size_t)f->columns + FFT2D_BLOCK - 1) / FFT2D_BLOCK * FFT2D_BLOCK);
    f->work = mem_zeroed((size_t)f->threads, sizeof *f->work);
    bool good = f->work && !fft_line_create(&f->row, width, real ? FFT_REAL : FFT_FORWARD) &&
                !fft_line_create(&f->row_back, width, real ? FFT_REAL_INVERSE : FFT_INVERSE) &&
                !fft_line_create(&f->column, height, FFT_FORWARD) &&
                !fft_line_create(&f->column_back, height, FFT_INVERSE);
    for (int i = 0; good && i < f->threads; i++)
        good = (f->work[i] = mem_array(work_floats(f), sizeof **f->work)) != NULL;
    *out = f;
    if (!good)
        fft2d_destroy(out);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

void fft2d_destroy(fft2d **f)
{
    if (!*f)
        return;
    fft_line_destroy(&(*f)->row);
    fft_line_destroy(&(*f)->row_back);
    fft_line_destroy(&(*f)->column);
    fft_line_destroy(&(*f)->column_back);
    for (int i = 0; (*f)->work && i < (*f)->threads; i++)
        mem_free((*f)->work[i]);
    mem_free((*f)->work);
    mem_free(*f);
    *f = NULL;
}

int fft2d_columns(const fft2d *f)
{
    return f->columns;
}

size_t fft2d_size(const fft2d *f)
{
    return f->stride * (size_t)f->height;
}

// ---------------------------------------------------------------- rows

struct rows {
    const fft2d *f;
    float *spectrum;
    int from;
    void (*fill)(void *context, int row, float *line);
    void (*take)(void *context, int row, const float *line);
    void *context;
};

static void row_forward(void *context, size_t item, int worker)
{
    const struct rows *r = context;
    const int row = r->from + (int)item;
    float *const line = r->f->work[worker];
    float *const scratch = line + 2 * (((size_t)r->f->width + 3) / 2 * 2);
    r->fill(r->context, row, line);
    fft_line_run(r->f->row, line, r->spectrum + (size_t)row * r->f->stride, scratch);
}

static void row_back(void *context, size_t item, int worker)
{
    const struct rows *r = context;
    const int row = r->from + (int)item;
    float *const line = r->f->work[worker];
    float *const scratch = line + 2 * (((size_t)r->f->width + 3) / 2 * 2);
    fft_line_run(r->f->row_back, r->spectrum + (size_t)row * r->f->stride, line, scratch);
    r->take(r->context, row, line);
}

void fft2d_rows(const fft2d *f, float *spectrum, int from, int to,
                void (*fill)(void *context, int row, float *line), void *context)
{
    struct rows rows = {f, spectrum, from, fill, NULL, context};
    if (to > from)
        thread_for(f->threads, (size_t)(to - from), row_forward, &rows);
}

void fft2d_rows_back(const fft2d *f, float *spectrum, int from, int to,
                     void (*take)(void *context, int row, const float *line), void *context)
{
    struct rows rows = {f, spectrum, from, NULL, take, context};
    if (to > from)
        thread_for(f->threads, (size_t)(to - from), row_back, &rows);
}

// ---------------------------------------------------------------- columns

struct columns {
    const fft2d *f;
    float *spectrum;
    struct fft2d_step step;
};

static void gather(float *lines, const fft2d *f, const float *spectrum, int column, int count,
                   int from, int to)
{
    const size_t n = (size_t)f->height;
    for (int k = 0; k < count; k++) {
        memset(lines + 2 * n * (size_t)k, 0, 2 * (size_t)from * sizeof *lines);
        memset(lines + 2 * (n * (size_t)k + (size_t)to), 0, 2 * (n - (size_t)to) * sizeof *lines);
    }
    for (int y = from; y < to; y++) {
        const float *const row = spectrum + (size_t)y * f->stride + 2 * (size_t)column;
        for (int k = 0; k < count; k++)
            memcpy(lines + 2 * (n * (size_t)k + (size_t)y), row + 2 * k, 2 * sizeof *row);
    }
}

static void scatter(const float *lines, const fft2d *f, float *spectrum, int column, int count)
{
    const size_t n = (size_t)f->height;
    for (size_t y = 0; y < n; y++) {
        float *const row = spectrum + y * f->stride + 2 * (size_t)column;
        for (int k = 0; k < count; k++)
            memcpy(row + 2 * k, lines + 2 * (n * (size_t)k + y), 2 * sizeof *row);
    }
}

static void run_lines(const fft_line *line, const fft2d *f, float *in, float *out, int count,
                      float *scratch)
{
    for (int k = 0; k < count; k++)
        fft_line_run(line, in + 2 * (size_t)f->height * (size_t)k,
                     out + 2 * (size_t)f->height * (size_t)k, scratch);
}

static void column_block(void *context, size_t item, int worker)
{
    const struct columns *c = context;
    const fft2d *const f = c->f;
    const struct fft2d_step *const p = &c->step;
    const int column = p->first + (int)item * FFT2D_BLOCK;
    const int count = p->end - column < FFT2D_BLOCK ? p->end - column : FFT2D_BLOCK;
    const size_t block = 2 * FFT2D_BLOCK * (size_t)f->height;
    float *const a = f->work[worker], *const b = a + block, *const scratch = b + block;
    gather(a, f, c->spectrum, column, count, p->from, p->to);
    run_lines(f->column, f, a, b, count, scratch);
    if (p->visit && !p->visit(p->context, column, count, b))
        return;
    if (p->back)
        run_lines(f->column_back, f, b, a, count, scratch);
    scatter(p->back ? a : b, f, c->spectrum, column, count);
}

void fft2d_step_columns(const fft2d *f, float *spectrum, const struct fft2d_step *step)
{
    struct columns columns = {f, spectrum, *step};
    const int count = step->end - step->first;
    if (count > 0)
        thread_for(f->threads, ((size_t)count + FFT2D_BLOCK - 1) / FFT2D_BLOCK, column_block,
                   &columns);
}

static void column_back(void *context, size_t item, int worker)
{
    const struct columns *c = context;
    const fft2d *const f = c->f;
    const int column = (int)item * FFT2D_BLOCK;
    const int count = f->columns - column < FFT2D_BLOCK ? f->columns - column : FFT2D_BLOCK;
    const size_t block = 2 * FFT2D_BLOCK * (size_t)f->height;
    float *const a = f->work[worker], *const b = a + block, *const scratch = b + block;
    gather(a, f, c->spectrum, column, count, 0, f->height);
    run_lines(f->column_back, f, a, b, count, scratch);
    scatter(b, f, c->spectrum, column, count);
}

void fft2d_columns_back(const fft2d *f, float *spectrum)
{
    struct columns columns = {f, spectrum, {0}};
    thread_for(f->threads, ((size_t)f->columns + FFT2D_BLOCK - 1) / FFT2D_BLOCK, column_back,
               &columns);
}
