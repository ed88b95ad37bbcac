// components.c - local principal components by the products of the taught vectors: vectors are
// longer than they are many, so that all is found from their Gram matrix, that of a cluster from a
// part of it (the "snapshots" of Sirovich 1987)
#include "baked/components.h"

#include "base/memory.h"
#include "base/thread.h"
#include "math/lsq.h"

#include <math.h>
#include <relume/codebook.h>
#include <string.h>

enum { ROWS = 64, COLUMNS = 512, REDUCED = 32 };

// ---------------------------------------------------------------- products

struct products {
    const float *rows;
    size_t count, stride, length;
    double *gram;
    bool failed;  // set by any worker, read after all
};

// Some rows with all, some columns at a time.
static bool add_products(const struct products *p, size_t first, size_t n, float *turned,
                         float *part)
{
    for (size_t at = 0; at < p->length; at += COLUMNS) {
        const size_t some = p->length - at < COLUMNS ? p->length - at : COLUMNS;
        for (size_t i = 0; i < p->count; i++)
            for (size_t j = 0; j < some; j++)
                turned[j * p->count + i] = p->rows[i * p->stride + at + j];
        lsq_multiply((int)n, (int)p->count, (int)some, p->rows + first * p->stride + at,
                     (int)p->stride, turned, (int)p->count, part, (int)p->count);
        for (size_t i = 0; i < n * p->count; i++)
            p->gram[first * p->count + i] += (double)part[i];
    }
    return true;
}

static void products_of_rows(void *context, size_t item, int worker)
{
    (void)worker;
    struct products *p = context;
    const size_t first = item * ROWS, left = p->count - first;
    float *turned = mem_array(COLUMNS * p->count, sizeof *turned);
    float *part = mem_array(ROWS * p->count, sizeof *part);
    if (!turned || !part || !add_products(p, first, left < ROWS ? left : ROWS, turned, part))
        __atomic_store_n(&p->failed, true, __ATOMIC_RELAXED);
    mem_free(turned);
    mem_free(part);
}

// Products of differences from the mean of those `n` members.
static void centre(double *out, const double *gram, size_t count, const size_t *member, size_t n)
{
    double all = 0.0;
    double *mean = out + n * n;
    for (size_t i = 0; i < n; i++) {
        mean[i] = 0.0;
        for (size_t j = 0; j < n; j++) {
            out[i * n + j] = gram[member[i] * count + member[j]];
            mean[i] += out[i * n + j] / (double)n;
        }
        all += mean[i] / (double)n;
    }
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            out[i * n + j] += all - mean[i] - mean[j];
}

// ---------------------------------------------------------------- clusters

struct learning {
    const struct local_components *out;
    const struct products *p;
    const uint16_t *which;
    bool failed;  // set by any worker, read after all
};

static relume_status reduce(float *reduced, const struct products *p, size_t *member)
{
    const size_t n = p->count;
    const int kept = (int)(n < REDUCED ? n : REDUCED);
    double *gram = mem_array(n * (n + 1), sizeof *gram);
    double *vectors = mem_array((size_t)kept * n, sizeof *vectors), values[REDUCED];
    bool good = gram && vectors;
    for (size_t i = 0; i < n; i++)
        member[i] = i;
    if (good) {
        centre(gram, p->gram, n, member, n);
        good = lsq_eigenvectors(gram, (int)n, kept, values, vectors);
    }
    memset(reduced, 0, n * REDUCED * sizeof *reduced);
    for (size_t i = 0; good && i < n; i++)
        for (int k = 0; k < kept; k++)
            reduced[i * REDUCED + (size_t)k] =
                (float)(vectors[(size_t)k * n + i] * sqrt(fmax(values[k], 0.0)));
    mem_free(gram);
    mem_free(vectors);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status find_clusters(uint16_t *which, int clusters, const float *reduced, size_t n,
                                   int threads)
{
    relume_codebook *book = NULL;
    relume_status status = relume_codebook_train(
        &book, reduced, n, REDUCED,
        relume_codebook_params(.start = RELUME_START_SPLIT, .codes = clusters, .threads = threads));
    if (!status)
        status = relume_codebook_assign(book, reduced, n, which, NULL,
                                        relume_codebook_assign_params(.threads = threads));
    relume_codebook_destroy(&book);
    return status;
}

// A unit component is the sum of the members' differences from the mean by an eigenvector.
static void add_component(float *to, const float *mean, const struct products *p,
                          const size_t *member, size_t n, const double *share, double value)
{
    const double scale = value > 0.0 ? 1.0 / sqrt(value) : 0.0;
    double sum = 0.0;
    memset(to, 0, p->length * sizeof *to);
    for (size_t i = 0; i < n; i++) {
        const float part = (float)(share[i] * scale);
        const float *row = p->rows + member[i] * p->stride;
        for (size_t j = 0; j < p->length; j++)
            to[j] += part * (row[j] - mean[j]);
    }
    for (size_t j = 0; j < p->length; j++)
        sum += (double)to[j] * (double)to[j];
    for (size_t j = 0; j < p->length && sum > 0.0; j++)
        to[j] = (float)((double)to[j] / sqrt(sum));
}

static bool solve(const struct learning *l, int cluster, const size_t *member, size_t n)
{
    const size_t length = l->p->length, most = (size_t)l->out->components;
    float *mean = l->out->vector + (size_t)cluster * (1 + most) * length;
    const int kept = (int)(most < n ? most : n);
    double *gram = mem_array(n * (n + 1), sizeof *gram);
    double *vectors = mem_array((size_t)kept * n, sizeof *vectors);
    double *values = mem_array((size_t)kept, sizeof *values);
    bool good = gram && vectors && values;
    memset(mean, 0, (1 + most) * length * sizeof *mean);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < length; j++)
            mean[j] += l->p->rows[member[i] * l->p->stride + j] / (float)n;
    if (good && kept) {
        centre(gram, l->p->gram, l->p->count, member, n);
        const double all = gram[0];
        good = lsq_eigenvectors(gram, (int)n, kept, values, vectors);
        for (int k = 0; good && k < kept; k++)
            // beyond the rank what is left is rounding
            if (values[k] > 1e-6 * fmax(values[0], all))
                add_component(mean + (size_t)(k + 1) * length, mean, l->p, member, n,
                              vectors + (size_t)k * n, values[k]);
    }
    mem_free(gram);
    mem_free(vectors);
    mem_free(values);
    return good;
}

static void learn_cluster(void *context, size_t item, int worker)
{
    (void)worker;
    struct learning *l = context;
    size_t *member = mem_array(l->p->count, sizeof *member), n = 0;
    for (size_t i = 0; member && i < l->p->count; i++)
        if (l->which[i] == item)
            member[n++] = i;
    if (!member || !solve(l, (int)item, member, n))
        __atomic_store_n(&l->failed, true, __ATOMIC_RELAXED);
    mem_free(member);
}

relume_status components_learn(const struct local_components *out, const float *rows, size_t taught,
                               size_t stride, int threads)
{
    struct products p = {
        rows, taught, stride, out->length, mem_zeroed(taught * taught, sizeof *p.gram), false};
    float *reduced = mem_array(taught * REDUCED, sizeof *reduced);
    size_t *member = mem_array(taught, sizeof *member);
    uint16_t *which = mem_array(taught, sizeof *which);
    relume_status status = p.gram && reduced && member && which ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        thread_for(threads, (taught + ROWS - 1) / ROWS, products_of_rows, &p);
        status = p.failed ? RELUME_ENOMEM : reduce(reduced, &p, member);
    }
    if (!status)
        status = find_clusters(which, out->clusters, reduced, taught, threads);
    if (!status) {
        struct learning l = {out, &p, which, false};
        thread_for(threads, (size_t)out->clusters, learn_cluster, &l);
        status = l.failed ? RELUME_ENOMEM : RELUME_OK;
    }
    mem_free(p.gram);
    mem_free(reduced);
    mem_free(member);
    mem_free(which);
    return status;
}

// ---------------------------------------------------------------- of a vector

int components_nearest(const struct local_components *c, const float *y)
{
    int best = 0;
    float least = INFINITY;
    for (int k = 0; k < c->clusters; k++) {
        const float *mean = c->vector + (size_t)k * (size_t)(1 + c->components) * c->length;
        float sum = 0.0f;
        for (size_t j = 0; j < c->length; j++)
            sum += (y[j] - mean[j]) * (y[j] - mean[j]);
        if (sum < least) {
            least = sum;
            best = k;
        }
    }
    return best;
}

double components_weights(float *weights, const struct local_components *c, int cluster,
                          const float *y, float *left)
{
    const float *mean = c->vector + (size_t)cluster * (size_t)(1 + c->components) * c->length;
    const float *e = mean + c->length;
    double square = 0.0;
    for (size_t j = 0; j < c->length; j++)
        left[j] = y[j] - mean[j];
    for (int k = 0; k < c->components; k++, e += c->length) {
        double along = 0.0, own = 0.0;
        for (size_t j = 0; j < c->length; j++) {
            along += (double)(left[j] * e[j]);
            own += (double)(e[j] * e[j]);
        }
        weights[k] = own > 0.0 ? (float)(along / own) : 0.0f;
        for (size_t j = 0; j < c->length; j++)
            left[j] -= weights[k] * e[j];
    }
    for (size_t j = 0; j < c->length; j++)
        square += (double)(left[j] * left[j]);
    return square;
}
