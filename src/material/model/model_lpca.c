// model_lpca.c - local principal components of apparent BRDFs (Mueller, Meseth, Klein 2003): texels
// in clusters, each with a mean and components of its own
//     BTF(x, v, l) ~ mean_c(v, l) + sum_k weight_k(x) pattern_kc(v, l),   c = cluster(x)
//
// Clusters come from k-means, then from a generalised Lloyd iteration (Kambhatla and Leen 1997) in
// which a texel joins the cluster that reconstructs it best. Both work on reduced texels; the
// components of the final clusters are those of the values themselves.
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "material/model/reduce.h"
#include "core/base/half.h"
#include "core/math/lsq.h"

#include <string.h>

enum { MEAN, PATTERN, WEIGHT, CLUSTER };
enum { REDUCED = 96, ROUNDS = 12, CHUNK = 256 };
// Texels whose products decide the components of a cluster: beyond, every n-th of them.
enum { SUBSET = 512 };

static void layout(relume_btf_fitted *m)
{
    const size_t c = (size_t)m->clusters, k = (size_t)m->components;
    const size_t v = (size_t)m->views, l = (size_t)m->lights;
    model_add(m, "mean", NPY_HALF, false, 0, MODEL_SHAPE(c, v, l, 3));
    model_add(m, "pattern", NPY_HALF, false, 0, MODEL_SHAPE(c, k, v, l, 3));
    model_add(m, "weight", NPY_HALF, true, 0, MODEL_SHAPE(m->texels, k));
    model_add(m, "cluster", NPY_U8, true, c, MODEL_SHAPE(m->texels));
}

// ---------------------------------------------------------------- generalised Lloyd iteration

struct local {
    const struct fitting *f;
    const struct reduced *r;
    const struct members *members;
    int *which;
    double *squared;  // [texels]: of the best reconstruction
    double *mean;     // [clusters][count]
    double *vector;   // [clusters][components][count]
    bool failed;      // set by any worker, read after all
};

static bool solve(const struct local *p, size_t cluster, double *gram, double *row)
{
    const size_t n = (size_t)p->r->count, k = (size_t)p->f->out->components;
    const size_t from = p->members->first[cluster], end = p->members->first[cluster + 1];
    double *mean = p->mean + cluster * n, values[256];
    for (size_t i = from; i < end; i++)
        for (size_t j = 0; j < n; j++)
            mean[j] += (double)p->r->score[p->members->texel[i] * n + j] / (double)(end - from);
    for (size_t i = from; i < end; i++) {
        for (size_t j = 0; j < n; j++)
            row[j] = (double)p->r->score[p->members->texel[i] * n + j] - mean[j];
        lsq_add_gram(gram, (int)n, row, 1);
    }
    return lsq_eigenvectors(gram, (int)n, (int)(k < n ? k : n), values,
                            p->vector + cluster * k * n);
}

static void solve_cluster(void *context, size_t item, int worker)
{
    (void)worker;
    struct local *p = context;
    const size_t n = (size_t)p->r->count;
    double *gram = mem_zeroed(n * n, sizeof *gram), *row = mem_array(n, sizeof *row);
    if (!gram || !row || !solve(p, item, gram, row))
        __atomic_store_n(&p->failed, true, __ATOMIC_RELAXED);
    mem_free(gram);
    mem_free(row);
}

static double residual(const struct local *p, const double *x, size_t cluster)
{
    const size_t n = (size_t)p->r->count, k = (size_t)p->f->out->components;
    const double *mean = p->mean + cluster * n, *vector = p->vector + cluster * k * n;
    double d[REDUCED], sum = 0.0;
    for (size_t j = 0; j < n; j++) {
        d[j] = x[j] - mean[j];
        sum += d[j] * d[j];
    }
    for (size_t i = 0; i < k; i++, vector += n) {
        double along = 0.0;
        for (size_t j = 0; j < n; j++)
            along += d[j] * vector[j];
        sum -= along * along;
    }
    return sum;
}

static void choose_chunk(void *context, size_t item, int worker)
{
    (void)worker;
    const struct local *p = context;
    const size_t n = (size_t)p->r->count, end = (item + 1) * CHUNK;
    for (size_t i = item * CHUNK; i < (end < p->r->texels ? end : p->r->texels); i++) {
        double x[REDUCED];
        p->squared[i] = INFINITY;
        for (size_t j = 0; j < n; j++)
            x[j] = (double)p->r->score[i * n + j];
        for (int c = 0; c < p->f->out->clusters; c++) {
            const double e = residual(p, x, (size_t)c);
            if (e < p->squared[i]) {
                p->squared[i] = e;
                p->which[i] = c;
            }
        }
    }
}

static relume_status round_of(struct local *p, double *error)
{
    const size_t clusters = (size_t)p->f->out->clusters, n = (size_t)p->r->count;
    const size_t k = (size_t)p->f->out->components;
    struct members members;
    relume_status status = members_make(&members, p->which, p->r->texels, (int)clusters);
    if (status)
        return status;
    p->members = &members;
    memset(p->mean, 0, clusters * n * sizeof *p->mean);
    memset(p->vector, 0, clusters * k * n * sizeof *p->vector);
    thread_for(p->f->threads, clusters, solve_cluster, p);
    members_free(&members);
    p->members = NULL;
    if (p->failed)
        return RELUME_ENOMEM;
    thread_for(p->f->threads, (p->r->texels + CHUNK - 1) / CHUNK, choose_chunk, p);
    *error = 0.0;
    for (size_t i = 0; i < p->r->texels; i++)
        *error += fmax(p->squared[i], 0.0);
    return RELUME_OK;
}

static relume_status lloyd(const struct fitting *f, const struct reduced *r, int *which)
{
    const size_t clusters = (size_t)f->out->clusters, n = (size_t)r->count;
    struct local p = {
        .f = f,
        .r = r,
        .which = which,
        .squared = mem_array(r->texels, sizeof *p.squared),
        .mean = mem_array(clusters * n, sizeof *p.mean),
        .vector = mem_array(clusters * (size_t)f->out->components * n, sizeof *p.vector),
    };
    relume_status status = p.squared && p.mean && p.vector ? RELUME_OK : RELUME_ENOMEM;
    double before = INFINITY, now = 0.0;
    for (int i = 0; i < ROUNDS && !status; i++) {
        status = round_of(&p, &now);
        if (before - now <= 1e-3 * before)
            break;
        before = now;
    }
    mem_free(p.squared);
    mem_free(p.mean);
    mem_free(p.vector);
    return status;
}

// ---------------------------------------------------------------- the components of a cluster

struct final {
    const struct fitting *f;
    const struct members *members;
    bool failed;  // set by any worker, read after all
};

// What one cluster needs.
struct cluster {
    size_t values, count;  // of a texel; texels whose products are taken
    float *row;            // [count][values], mean removed
    float *turned;         // [values][count]
    float *product;        // [count][count]
    double *gram, *root, *vector;
    double *mean;    // [values]
    float *pattern;  // [components][values]
    float *texel;    // [values]
};

static void free_cluster(struct cluster *s)
{
    mem_free(s->row);
    mem_free(s->turned);
    mem_free(s->product);
    mem_free(s->gram);
    mem_free(s->root);
    mem_free(s->vector);
    mem_free(s->mean);
    mem_free(s->pattern);
    mem_free(s->texel);
}

static bool alloc_cluster(struct cluster *s, size_t components)
{
    s->row = mem_array(s->count * s->values, sizeof *s->row);
    s->turned = mem_array(s->count * s->values, sizeof *s->turned);
    s->product = mem_array(s->count * s->count, sizeof *s->product);
    s->gram = mem_array(s->count * s->count, sizeof *s->gram);
    s->root = mem_array(s->count, sizeof *s->root);
    s->vector = mem_array(components * s->count, sizeof *s->vector);
    s->mean = mem_zeroed(s->values, sizeof *s->mean);
    s->pattern = mem_zeroed(components * s->values, sizeof *s->pattern);
    s->texel = mem_array(s->values, sizeof *s->texel);
    return s->row && s->turned && s->product && s->gram && s->root && s->vector && s->mean &&
           s->pattern && s->texel;
}

static void find_mean(const struct final *p, struct cluster *s, size_t from, size_t end,
                      uint16_t *stored)
{
    for (size_t i = from; i < end; i++) {
        btf_gather(p->f->btf, p->members->texel[i], 1, s->texel);
        for (size_t j = 0; j < s->values; j++)
            s->mean[j] += (double)s->texel[j];
    }
    for (size_t j = 0; j < s->values; j++) {
        stored[j] = half_from_float((float)(s->mean[j] / (double)(end - from)));
        s->mean[j] = (double)float_from_half(stored[j]);
    }
}

// Unit patterns from the eigenvectors of the products between texels.
static bool find_patterns(const struct final *p, struct cluster *s, size_t from, size_t end,
                          int components)
{
    const size_t n = s->count;
    for (size_t i = 0; i < n; i++) {
        float *row = s->row + i * s->values;
        btf_gather(p->f->btf, p->members->texel[from + i * (end - from) / n], 1, row);
        for (size_t j = 0; j < s->values; j++) {
            row[j] -= (float)s->mean[j];
            s->turned[j * n + i] = row[j];
        }
    }
    lsq_multiply((int)n, (int)n, (int)s->values, s->row, (int)s->values, s->turned, (int)n,
                 s->product, (int)n);
    for (size_t i = 0; i < n * n; i++)
        s->gram[i] = (double)s->product[i];
    const int found = components < (int)n ? components : (int)n;
    if (!lsq_eigenvectors(s->gram, (int)n, found, s->root, s->vector))
        return false;
    for (int k = 0; k < found; k++) {
        float *pattern = s->pattern + (size_t)k * s->values;
        if (!(s->root[k] > 1e-7 * s->root[0]) || !(s->root[k] > 1e-12))
            break;
        for (size_t i = 0; i < n; i++) {
            const float w = (float)(s->vector[(size_t)k * n + i] / sqrt(s->root[k]));
            for (size_t j = 0; j < s->values; j++)
                pattern[j] += w * s->row[i * s->values + j];
        }
    }
    return true;
}

static void find_weights(const struct final *p, struct cluster *s, size_t from, size_t end)
{
    const relume_btf_fitted *m = p->f->out;
    const size_t components = (size_t)m->components;
    const double scale = sqrt((double)s->values);  // patterns are stored with mean square 1
    for (size_t i = from; i < end; i++) {
        const size_t texel = p->members->texel[i];
        btf_gather(p->f->btf, texel, 1, s->texel);
        for (size_t k = 0; k < components; k++) {
            const float *pattern = s->pattern + k * s->values;
            double sum = 0.0;
            for (size_t j = 0; j < s->values; j++)
                sum += ((double)s->texel[j] - s->mean[j]) * (double)pattern[j];
            model_halfs(m, WEIGHT)[texel * components + k] = half_from_float((float)(sum / scale));
        }
    }
}

static void finish_cluster(void *context, size_t item, int worker)
{
    (void)worker;
    struct final *p = context;
    const relume_btf_fitted *m = p->f->out;
    const size_t from = p->members->first[item], end = p->members->first[item + 1];
    const size_t components = (size_t)m->components;
    if (from == end)
        return;
    struct cluster s = {.values = 3 * model_pairs(m),
                        .count = end - from < SUBSET ? end - from : SUBSET};
    bool good = alloc_cluster(&s, components);
    if (good) {
        find_mean(p, &s, from, end, model_halfs(m, MEAN) + item * s.values);
        good = find_patterns(p, &s, from, end, m->components);
    }
    if (good) {
        const float scale = sqrtf((float)s.values);
        uint16_t *stored = model_halfs(m, PATTERN) + item * components * s.values;
        for (size_t j = 0; j < components * s.values; j++)
            stored[j] = half_from_float(s.pattern[j] * scale);
        find_weights(p, &s, from, end);
    } else {
        __atomic_store_n(&p->failed, true, __ATOMIC_RELAXED);
    }
    free_cluster(&s);
}

static relume_status finish(struct fitting *f, const int *which)
{
    relume_btf_fitted *m = f->out;
    struct members members;
    const relume_status status = members_make(&members, which, m->texels, m->clusters);
    if (status)
        return status;
    struct final p = {f, &members, false};
    thread_for(f->threads, (size_t)m->clusters, finish_cluster, &p);
    for (size_t i = 0; i < m->texels; i++)
        ((uint8_t *)m->array[CLUSTER].data)[i] = (uint8_t)which[i];
    members_free(&members);
    return p.failed ? RELUME_ENOMEM : RELUME_OK;
}

static relume_status fit(struct fitting *f)
{
    relume_btf_fitted *m = f->out;
    struct reduced r = {.score = NULL};
    int *which = mem_array(m->texels, sizeof *which);
    relume_status status = which ? reduce_make(&r, f, REDUCED) : RELUME_ENOMEM;
    if (!status)
        status = reduce_cluster(&r, f, m->clusters, which);
    if (!status)
        status = lloyd(f, &r, which);
    if (!status)
        status = finish(f, which);
    reduce_free(&r);
    mem_free(which);
    return status;
}

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    const size_t components = (size_t)m->components, values = 3 * model_pairs(m);
    const size_t cluster = ((const uint8_t *)m->array[CLUSTER].data)[at->texel];
    const size_t pair = (size_t)at->view * (size_t)m->lights + (size_t)at->light;
    const uint16_t *mean = model_halfs(m, MEAN) + cluster * values + 3 * pair;
    const uint16_t *pattern = model_halfs(m, PATTERN) + cluster * components * values + 3 * pair;
    const uint16_t *weight = model_halfs(m, WEIGHT) + at->texel * components;
    for (int c = 0; c < 3; c++)
        rgb[c] = float_from_half(mean[c]);
    model_add_components(rgb, m, weight, pattern);
}

// Mean and components of nine pairs.
static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    const int k = m->components;
    return (struct relume_btf_cost){
        .fetches = 1 + (k + 3) / 4 + 2, .light_ops = 9 * (k + 1), .light_fetches = 2 + 9 * (k + 1)};
}

const struct relume_btf_model model_lpca = {
    .name = "lpca",
    .summary = "principal components within clusters of texels",
    .view_grid = true,
    .light_grid = true,
    .clusters = 32,
    .most_clusters = 256,
    .components = 8,
    .layout = layout,
    .fit = fit,
    .eval = eval,
    .cost = cost,
};
