// reduce.c - randomised singular vectors out of core (Halko, Martinsson, Tropp 2011)
//
// A is values x texels. It is read view by view, a slab of lights * 3 rows, and never held whole.
// A random sketch of its rows is multiplied by A' and A in turn, made orthonormal in between, so
// that the leading directions win; then the small problem is solved.
#include "material/model/reduce.h"

#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"
#include "core/math/random.h"
#include "material/btf/values.h"

#include <string.h>

enum { SPARE = 16, POWERS = 2, GROUP = 8, BLOCK = 1024 };

struct reduction {
    const struct fitting *f;
    size_t texels, slab, values;  // slab: rows of A that one view has
    int width;                    // of the sketch
    float *across;                // [width][texels]
    float *across_turned;         // [texels][width]
    float *along;                 // [values][width]
    float *along_turned;          // [values / slab][width][slab]
    float *view[GROUP];           // [slab][texels]: rows of A
    float *part[GROUP];           // [width][texels]
    size_t first_view;
};

static void free_work(struct reduction *w)
{
    mem_free(w->across);
    mem_free(w->across_turned);
    mem_free(w->along);
    mem_free(w->along_turned);
    for (int i = 0; i < GROUP; i++) {
        mem_free(w->view[i]);
        mem_free(w->part[i]);
    }
}

static bool alloc_work(struct reduction *w)
{
    const size_t width = (size_t)w->width;
    w->across = mem_array(width * w->texels, sizeof(float));
    w->across_turned = mem_array(width * w->texels, sizeof(float));
    w->along = mem_array(width * w->values, sizeof(float));
    w->along_turned = mem_array(width * w->values, sizeof(float));
    bool good = w->across && w->across_turned && w->along && w->along_turned;
    for (int i = 0; i < GROUP && good; i++) {
        w->view[i] = mem_array(w->slab * w->texels, sizeof(float));
        w->part[i] = mem_array(width * w->texels, sizeof(float));
        good = w->view[i] && w->part[i];
    }
    return good;
}

static void load_view(const struct reduction *w, int view, float *out)
{
    for (int l = 0; l < w->f->btf->info.lights; l++) {
        const uint16_t *p = relume_btf_picture(w->f->btf, view, l);
        float *row = out + 3 * (size_t)l * w->texels;
        for (size_t i = 0; i < w->texels; i++)
            for (size_t c = 0; c < 3; c++)
                row[c * w->texels + i] = float_from_half(p[3 * i + c]);
    }
}

// ---------------------------------------------------------------- products with A, by views

static void across_view(void *context, size_t item, int worker)
{
    (void)worker;
    struct reduction *w = context;
    const size_t v = w->first_view + item;
    load_view(w, (int)v, w->view[item]);
    lsq_multiply(w->width, (int)w->texels, (int)w->slab,
                 w->along_turned + v * w->slab * (size_t)w->width, (int)w->slab, w->view[item],
                 (int)w->texels, w->part[item], (int)w->texels);
}

static void along_view(void *context, size_t item, int worker)
{
    (void)worker;
    struct reduction *w = context;
    const size_t v = w->first_view + item;
    load_view(w, (int)v, w->view[item]);
    lsq_multiply((int)w->slab, w->width, (int)w->texels, w->view[item], (int)w->texels,
                 w->across_turned, w->width, w->along + v * w->slab * (size_t)w->width, w->width);
}

static void turn(const float *from, size_t rows, size_t columns, float *to)
{
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j < columns; j++)
            to[j * rows + i] = from[i * columns + j];
}

// across = along' A, its parts added in the order of the views.
static void multiply_across(struct reduction *w)
{
    const size_t views = w->values / w->slab, size = (size_t)w->width * w->texels;
    for (size_t v = 0; v < views; v++)
        turn(w->along + v * w->slab * (size_t)w->width, w->slab, (size_t)w->width,
             w->along_turned + v * w->slab * (size_t)w->width);
    memset(w->across, 0, size * sizeof *w->across);
    for (w->first_view = 0; w->first_view < views; w->first_view += GROUP) {
        const size_t left = views - w->first_view, n = left < GROUP ? left : GROUP;
        thread_for(w->f->threads, n, across_view, w);
        for (size_t k = 0; k < n; k++)
            for (size_t i = 0; i < size; i++)
                w->across[i] += w->part[k][i];
    }
}

// along = A across'.
static void multiply_along(struct reduction *w)
{
    const size_t views = w->values / w->slab;
    turn(w->across, (size_t)w->width, w->texels, w->across_turned);
    for (w->first_view = 0; w->first_view < views; w->first_view += GROUP) {
        const size_t left = views - w->first_view;
        thread_for(w->f->threads, left < GROUP ? left : GROUP, along_view, w);
    }
}

// ---------------------------------------------------------------- small problems

// gram[m][m] = columns' columns of columns[n][m].
static bool gram_of(const float *columns, size_t n, int m, double *gram)
{
    double *rows = mem_array(BLOCK * (size_t)m, sizeof *rows);
    memset(gram, 0, (size_t)m * (size_t)m * sizeof *gram);
    for (size_t first = 0; rows && first < n; first += BLOCK) {
        const size_t count = n - first < BLOCK ? n - first : BLOCK;
        for (size_t i = 0; i < count * (size_t)m; i++)
            rows[i] = (double)columns[first * (size_t)m + i];
        lsq_add_gram(gram, m, rows, (int)count);
    }
    mem_free(rows);
    return rows != NULL;
}

// along[values][width] -> orthonormal columns, by the Cholesky factor of their Gram matrix.
static bool orthonormalise(struct reduction *w)
{
    const size_t m = (size_t)w->width;
    double *gram = mem_array(m * m, sizeof *gram);
    float *turned = mem_array(m * m, sizeof *turned), *out = NULL;
    bool good = gram && turned;
    for (int again = 0; again < 2 && good; again++) {  // twice: floats
        double trace = 0.0;
        good = gram_of(w->along, w->values, w->width, gram);
        for (size_t i = 0; i < m && good; i++)
            trace += gram[i * m + i];
        for (size_t i = 0; i < m && good; i++)
            gram[i * m + i] += 1e-12 * trace + 1e-30;
        good = good && lsq_cholesky(gram, w->width) && lsq_invert_lower(gram, w->width);
        out = good ? mem_array(m * w->values, sizeof *out) : NULL;
        good = out != NULL;
        if (!good)
            break;
        for (size_t i = 0; i < m; i++)
            for (size_t j = 0; j < m; j++)
                turned[j * m + i] = (float)gram[i * m + j];
        lsq_multiply((int)w->values, w->width, w->width, w->along, w->width, turned, w->width, out,
                     w->width);
        mem_free(w->along);
        w->along = out;
    }
    mem_free(gram);
    mem_free(turned);
    return good;
}

// The singular directions inside the sketch: scores and basis.
static bool finish(struct reduction *w, struct reduced *out)
{
    const size_t m = (size_t)w->width, count = (size_t)out->count;
    double *gram = mem_array(m * m, sizeof *gram), *values = mem_array(count, sizeof *values);
    double *vectors = mem_array(count * m, sizeof *vectors);
    float *rotate = mem_array(count * m, sizeof *rotate);  // [m][count]
    bool good = gram && values && vectors && rotate;
    turn(w->across, m, w->texels, w->across_turned);
    good = good && gram_of(w->across_turned, w->texels, w->width, gram) &&
           lsq_eigenvectors(gram, w->width, out->count, values, vectors);
    for (size_t k = 0; k < count && good; k++)
        for (size_t i = 0; i < m; i++)
            rotate[i * count + k] = (float)vectors[k * m + i];
    if (good) {
        lsq_multiply((int)w->texels, out->count, w->width, w->across_turned, w->width, rotate,
                     out->count, out->score, out->count);
        float *turned = w->along_turned;  // [values][count] before the turn
        lsq_multiply((int)w->values, out->count, w->width, w->along, w->width, rotate, out->count,
                     turned, out->count);
        turn(turned, w->values, count, out->basis);
    }
    mem_free(gram);
    mem_free(values);
    mem_free(vectors);
    mem_free(rotate);
    return good;
}

static relume_status reduce_matrix(struct reduction *w, struct reduced *out)
{
    struct random random = random_stream(w->f->seed, w->values, w->texels);
    for (size_t i = 0; i < w->values * (size_t)w->width; i++)
        w->along[i] = (float)random_range(&random, -1.0, 1.0);
    for (int power = 0; power <= POWERS; power++) {
        if (!orthonormalise(w))
            return RELUME_ENOMEM;
        multiply_across(w);
        if (!log_progress(w->f->log, "reducing", (power + 1.0) / (POWERS + 1.0)))
            return RELUME_ECANCEL;
        if (power < POWERS)
            multiply_along(w);
    }
    return finish(w, out) ? RELUME_OK : RELUME_ENOMEM;
}

relume_status reduce_make(struct reduced *out, const struct fitting *f, int count)
{
    const relume_btf_fitted *m = f->out;
    struct reduction w = {
        .f = f,
        .texels = m->texels,
        .slab = 3 * (size_t)m->lights,
        .values = 3 * model_pairs(m),
    };
    const size_t most = w.texels < w.values ? w.texels : w.values;
    *out = (struct reduced){.texels = w.texels, .values = w.values};
    out->count = (size_t)count < most ? count : (int)most;
    w.width = (size_t)out->count + SPARE < most ? out->count + SPARE : (int)most;
    out->score = mem_array(w.texels * (size_t)out->count, sizeof *out->score);
    out->basis = mem_array(w.values * (size_t)out->count, sizeof *out->basis);
    relume_status status =
        out->score && out->basis && alloc_work(&w) ? reduce_matrix(&w, out) : RELUME_ENOMEM;
    free_work(&w);
    if (status)
        reduce_free(out);
    return status;
}

void reduce_free(struct reduced *r)
{
    mem_free(r->score);
    mem_free(r->basis);
    r->score = r->basis = NULL;
}
