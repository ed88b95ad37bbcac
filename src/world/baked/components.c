// components.c - local principal components by the products of the taught vectors: vectors are
// longer than they are many, so that all is found from their Gram matrices (the "snapshots" of
// Sirovich 1987)
#include "world/baked/components.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"

#include <math.h>
#include <relume/format/codebook.h>
#include <string.h>

enum { ROWS = 64, COLUMNS = 512, REDUCED = 32, CANDIDATES = 4 };

// ---------------------------------------------------------------- products

struct products {
    const float *rows;
    size_t count, stride, length;
    double *gram;
    bool failed;  // set by any worker, read after all
};

// Some rows with all, some columns at a time.
static void add_products(const struct products *p, size_t first, size_t n, float *turned,
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
}

static void products_of_rows(void *context, size_t item, int worker)
{
    (void)worker;
    struct products *p = context;
    const size_t first = item * ROWS, left = p->count - first;
    float *turned = mem_array(COLUMNS * p->count, sizeof *turned);
    float *part = mem_array(ROWS * p->count, sizeof *part);
    if (turned && part)
        add_products(p, first, left < ROWS ? left : ROWS, turned, part);
    else
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
    const float *rows;
    size_t count, stride;
    uint16_t *which;  // [count]
    bool failed;      // set by any worker, read after all
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

// The mean of each cluster of the `n` vectors that it was found from.
static void find_means(const struct learning *l, const uint16_t *which, size_t n)
{
    const size_t length = l->out->length, apart = (size_t)(1 + l->out->components) * length;
    memset(l->out->vector, 0, (size_t)l->out->clusters * apart * sizeof(float));
    for (int c = 0; c < l->out->clusters; c++) {
        float *mean = l->out->vector + (size_t)c * apart;
        size_t members = 0;
        for (size_t i = 0; i < n; i++)
            members += which[i] == c;
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; which[i] == c && j < length; j++)
                mean[j] += l->rows[i * l->count / n * l->stride + j] / (float)members;
    }
}

static void assign_rows(void *context, size_t item, int worker)
{
    (void)worker;
    struct learning *l = context;
    const size_t end = (item + 1) * ROWS;
    for (size_t i = item * ROWS; i < (end < l->count ? end : l->count); i++)
        l->which[i] = (uint16_t)components_nearest(l->out, l->rows + i * l->stride);
}

// A unit component is the sum of the members' differences from the mean by an eigenvector.
static void add_component(float *to, const float *difference, size_t n, size_t length,
                          const double *share)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < length; j++)
            to[j] += (float)share[i] * difference[i * length + j];
    for (size_t j = 0; j < length; j++)
        sum += (double)to[j] * (double)to[j];
    for (size_t j = 0; j < length && sum > 0.0; j++)
        to[j] = (float)((double)to[j] / sqrt(sum));
}

// What one cluster needs.
struct cluster {
    float *difference;  // [n][length]
    float *turned, *part;
    double *gram, *vectors, *values;
};

static void cluster_free(struct cluster *k)
{
    mem_free(k->difference);
    mem_free(k->turned);
    mem_free(k->part);
    mem_free(k->gram);
    mem_free(k->vectors);
    mem_free(k->values);
}

static bool cluster_alloc(struct cluster *k, size_t n, size_t length, size_t kept)
{
    *k = (struct cluster){
        .difference = mem_array(n * length, sizeof *k->difference),
        .turned = mem_array(COLUMNS * n, sizeof *k->turned),
        .part = mem_array(n * n, sizeof *k->part),
        .gram = mem_zeroed(n * n, sizeof *k->gram),
        .vectors = mem_array(kept * n, sizeof *k->vectors),
        .values = mem_array(kept, sizeof *k->values),
    };
    return k->difference && k->turned && k->part && k->gram && k->vectors && k->values;
}

// By at most so many members, which are evenly spread.
static bool solve(const struct learning *l, int cluster, const size_t *member, size_t members)
{
    enum { MOST = 512 };
    const size_t length = l->out->length, n = members < MOST ? members : MOST;
    const size_t most = (size_t)l->out->components, kept = most < n ? most : n;
    float *mean = l->out->vector + (size_t)cluster * (1 + most) * length;
    struct cluster k;
    memset(mean, 0, (1 + most) * length * sizeof *mean);
    for (size_t i = 0; i < members; i++)
        for (size_t j = 0; j < length; j++)
            mean[j] += l->rows[member[i] * l->stride + j] / (float)members;
    bool good = cluster_alloc(&k, n, length, kept);
    for (size_t i = 0; good && i < n; i++)
        for (size_t j = 0; j < length; j++)
            k.difference[i * length + j] =
                l->rows[member[i * members / n] * l->stride + j] - mean[j];
    if (good && kept) {
        const struct products p = {k.difference, n, length, length, k.gram, false};
        add_products(&p, 0, n, k.turned, k.part);
        good = lsq_eigenvectors(k.gram, (int)n, (int)kept, k.values, k.vectors);
        for (size_t i = 0; good && i < kept; i++)
            if (k.values[i] > 1e-6 * k.values[0])  // beyond the rank what is left is rounding
                add_component(mean + (i + 1) * length, k.difference, n, length, k.vectors + i * n);
    }
    cluster_free(&k);
    return good;
}

static void learn_cluster(void *context, size_t item, int worker)
{
    (void)worker;
    struct learning *l = context;
    size_t *member = mem_array(l->count, sizeof *member), n = 0;
    for (size_t i = 0; member && i < l->count; i++)
        if (l->which[i] == item)
            member[n++] = i;
    if (!member || !solve(l, (int)item, member, n))
        __atomic_store_n(&l->failed, true, __ATOMIC_RELAXED);
    mem_free(member);
}

// Clusters of some of the vectors, by their products.
static relume_status begin_clusters(struct learning *l, int threads)
{
    enum { SOME = 2048 };
    const size_t n = l->count < SOME ? l->count : SOME, length = l->out->length;
    float *some = mem_array(n * length, sizeof *some);
    float *reduced = mem_array(n * REDUCED, sizeof *reduced);
    size_t *member = mem_array(n, sizeof *member);
    uint16_t *which = mem_array(n, sizeof *which);
    struct products p = {some, n, length, length, mem_zeroed(n * n, sizeof *p.gram), false};
    relume_status status = p.gram && some && reduced && member && which ? RELUME_OK : RELUME_ENOMEM;
    for (size_t i = 0; i < n && !status; i++)
        memcpy(some + i * length, l->rows + i * l->count / n * l->stride, length * sizeof *some);
    if (!status) {
        thread_for(threads, (n + ROWS - 1) / ROWS, products_of_rows, &p);
        status = p.failed ? RELUME_ENOMEM : reduce(reduced, &p, member);
    }
    if (!status)
        status = find_clusters(which, l->out->clusters, reduced, n, threads);
    if (!status)
        find_means(l, which, n);
    mem_free(p.gram);
    mem_free(some);
    mem_free(reduced);
    mem_free(member);
    mem_free(which);
    return status;
}

relume_status components_learn(const struct local_components *out, const float *rows, size_t taught,
                               size_t stride, int threads)
{
    struct learning l = {out, rows, taught, stride, mem_array(taught, sizeof *l.which), false};
    relume_status status = l.which ? begin_clusters(&l, threads) : RELUME_ENOMEM;
    if (!status) {
        thread_for(threads, (taught + ROWS - 1) / ROWS, assign_rows, &l);
        thread_for(threads, (size_t)out->clusters, learn_cluster, &l);
        status = l.failed ? RELUME_ENOMEM : RELUME_OK;
    }
    mem_free(l.which);
    return status;
}

// ---------------------------------------------------------------- of a vector

static float distance(const struct local_components *c, int cluster, const float *y)
{
    const float *mean = c->vector + (size_t)cluster * (size_t)(1 + c->components) * c->length;
    float sum = 0.0f;
    for (size_t j = 0; j < c->length; j++)
        sum += (y[j] - mean[j]) * (y[j] - mean[j]);
    return sum;
}

int components_nearest(const struct local_components *c, const float *y)
{
    int best = 0;
    float least = INFINITY;
    for (int k = 0; k < c->clusters; k++) {
        const float d = distance(c, k, y);
        if (d < least) {
            least = d;
            best = k;
        }
    }
    return best;
}

// The nearest ones, nearest first.
static int some_nearest(int cluster[CANDIDATES], const struct local_components *c, const float *y)
{
    float d[CANDIDATES + 1];
    int own[CANDIDATES + 1] = {0}, n = 0;
    for (int k = 0; k < c->clusters; k++) {
        int at = n;
        const float value = distance(c, k, y);
        for (; at > 0 && value < d[at - 1]; at--) {
            d[at] = d[at - 1];
            own[at] = own[at - 1];
        }
        d[at] = value;
        own[at] = k;
        n = n < CANDIDATES ? n + 1 : n;
    }
    memcpy(cluster, own, (size_t)n * sizeof *cluster);
    return n;
}

// Weights of a cluster, one component after the other, so that these need not be quite orthogonal;
// the square of what is left.
static double weights_of(float *weights, const struct local_components *c, int cluster,
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

int components_best(float *weights, double *square, const struct local_components *c,
                    const float *y, float *left)
{
    int cluster[CANDIDATES], best = 0;
    const int n = some_nearest(cluster, c, y);
    *square = INFINITY;
    for (int i = 0; i < n; i++) {
        const double own = weights_of(weights, c, cluster[i], y, left);
        if (own < *square) {
            *square = own;
            best = cluster[i];
        }
    }
    *square = weights_of(weights, c, best, y, left);
    return best;
}
