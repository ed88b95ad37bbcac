// model_rfnlc.c - clustered reflectance fields (thesis, Procedure 1): texels in clusters, fields
// with lobes fitted to the mean of each cluster, one index a texel
#include "base/log.h"
#include "base/memory.h"
#include "base/thread.h"
#include "btf/fields.h"
#include "btf/reduce.h"

#include <string.h>

enum { CLUSTER = FIELD_ARRAYS };
// Numbers of a texel that clustering looks at, in place of its 19683 values.
enum { REDUCED = 48 };

static void layout(relume_btf_fitted *m)
{
    fields_layout(m, (size_t)m->clusters, false);
    model_add(m, "cluster", NPY_U16, true, (size_t)m->clusters, MODEL_SHAPE(m->texels));
}

struct work {
    struct fields fields;
    const struct fitting *f;
    const struct members *members;
    size_t first;
    bool failed;  // set by any worker, read after all
};

static bool fit_center(const struct work *w, size_t cluster)
{
    float *values = mem_array(3 * model_pairs(w->f->out), sizeof *values);
    const bool good = values && members_mean(w->members, cluster, w->f->btf, values) &&
                      fields_fit(&w->fields, cluster, values);
    free(values);
    return good;
}

static void fit_cluster(void *context, size_t item, int worker)
{
    (void)worker;
    struct work *w = context;
    if (!fit_center(w, w->first + item))
        __atomic_store_n(&w->failed, true, __ATOMIC_RELAXED);
}

static relume_status fit_clusters(struct work *w)
{
    enum { GROUP = 64 };
    const size_t clusters = (size_t)w->f->out->clusters;
    relume_status status = fields_start(&w->fields, w->f->out);
    for (; w->first < clusters && !status; w->first += GROUP) {
        const size_t left = clusters - w->first;
        thread_for(w->f->threads, left < GROUP ? left : GROUP, fit_cluster, w);
        if (w->failed)
            status = RELUME_ENOMEM;
        else if (!log_progress(w->f->log, "fitting",
                               fmin((double)(w->first + GROUP) / (double)clusters, 1.0)))
            status = RELUME_ECANCEL;
    }
    fields_end(&w->fields);
    return status;
}

static relume_status fit(struct fitting *f)
{
    relume_btf_fitted *m = f->out;
    struct members members = {NULL, NULL};
    struct work w = {.f = f, .members = &members};
    int *which = mem_array(m->texels, sizeof *which);
    relume_status status = which ? cluster_texels(f, REDUCED, which, &members) : RELUME_ENOMEM;
    if (!status)
        status = fit_clusters(&w);
    for (size_t i = 0; i < m->texels && !status; i++)
        ((uint16_t *)m->array[CLUSTER].data)[i] = (uint16_t)which[i];
    members_free(&members);
    free(which);
    return status;
}

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    fields_eval(m, ((const uint16_t *)m->array[CLUSTER].data)[at->texel], at, rgb);
}

static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    struct relume_btf_cost cost = fields_cost(m);
    cost.fetches++;  // which cluster
    return cost;
}

static void lit(const relume_btf_fitted *m, const struct model_at *at,
                const struct relume_btf_ambient *ambient, float rgb[3])
{
    fields_lit(m, ((const uint16_t *)m->array[CLUSTER].data)[at->texel], at, ambient, rgb);
}

const struct relume_btf_model model_rfnlc = {
    .name = "rfnlc",
    .summary = "cosine lobes for each view of clusters of texels",
    .view_grid = true,
    .clusters = 1024,
    .lobes = 2,
    .layout = layout,
    .fit = fit,
    .eval = eval,
    .cost = cost,
    .lit = lit,
};
