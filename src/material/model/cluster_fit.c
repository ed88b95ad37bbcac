// cluster_fit.c - a model fitted to the mean of each cluster of texels (thesis, Procedure 1)
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "material/model/reduce.h"

// Numbers of a texel that clustering looks at, in place of its 19683 values.
enum { REDUCED = 48 };
enum { GROUP = 64 };  // clusters between two words of progress

struct cluster_loop {
    const struct fitting *f;
    struct members members;
    bool (*fit)(const void *context, size_t cluster, const float *values);
    const void *context;
    size_t first;
    bool failed;  // set by any worker, read after all
};

static bool mean(const struct members *m, size_t cluster, const relume_btf *btf, float *values)
{
    const size_t n = 3 * (size_t)btf->info.views * (size_t)btf->info.lights;
    const size_t from = m->first[cluster], end = m->first[cluster + 1];
    double *sum = mem_zeroed(n, sizeof *sum);
    for (size_t i = from; i < end && sum; i++) {
        btf_gather(btf, m->texel[i], 1, values);
        for (size_t k = 0; k < n; k++)
            sum[k] += (double)values[k] / (double)(end - from);
    }
    for (size_t k = 0; k < n && sum; k++)
        values[k] = (float)sum[k];
    mem_free(sum);
    return sum != NULL;
}

static void fit_one(void *context, size_t item, int worker)
{
    (void)worker;
    struct cluster_loop *w = context;
    const size_t cluster = w->first + item;
    float *values = mem_array(3 * model_pairs(w->f->out), sizeof *values);
    if (!values || !mean(&w->members, cluster, w->f->btf, values) ||
        !w->fit(w->context, cluster, values))
        __atomic_store_n(&w->failed, true, __ATOMIC_RELAXED);
    mem_free(values);
}

static relume_status fit_all(struct cluster_loop *w)
{
    const size_t clusters = (size_t)w->f->out->clusters;
    for (; w->first < clusters; w->first += GROUP) {
        const size_t left = clusters - w->first;
        thread_for(w->f->threads, left < GROUP ? left : GROUP, fit_one, w);
        if (w->failed)
            return RELUME_ENOMEM;
        if (!log_progress(w->f->log, "fitting",
                          fmin((double)(w->first + GROUP) / (double)clusters, 1.0)))
            return RELUME_ECANCEL;
    }
    return RELUME_OK;
}

static relume_status cluster(const struct fitting *f, int *which, struct members *out)
{
    struct reduced r = {.score = NULL};
    const int clusters = f->out->clusters;
    relume_status status = reduce_make(&r, f, REDUCED);
    if (!status)
        status = reduce_cluster(&r, f, clusters, which);
    if (!status)
        status = members_make(out, which, f->out->texels, clusters);
    reduce_free(&r);
    return status;
}

relume_status clusters_fit(const struct fitting *f, int which,
                           bool (*fit)(const void *context, size_t cluster, const float *values),
                           const void *context)
{
    const size_t texels = f->out->texels;
    struct cluster_loop w = {.f = f, .members = {NULL, NULL}, .fit = fit, .context = context};
    int *number = mem_array(texels, sizeof *number);
    relume_status status = number ? cluster(f, number, &w.members) : RELUME_ENOMEM;
    if (!status)
        status = fit_all(&w);
    for (size_t i = 0; i < texels && !status; i++)
        ((uint16_t *)f->out->array[which].data)[i] = (uint16_t)number[i];
    members_free(&w.members);
    mem_free(number);
    return status;
}
