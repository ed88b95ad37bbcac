// model_rfnlc.c - clustered reflectance fields (thesis, Procedure 1): texels in clusters, fields
// with lobes fitted to the mean of each cluster, one index a texel
#include "material/model/environment.h"
#include "material/model/fields.h"
#include "material/model/reduce.h"

enum { CLUSTER = FIELD_ARRAYS };

static void layout(relume_btf_fitted *m)
{
    fields_layout(m, (size_t)m->clusters, false);
    model_add(m, "cluster", NPY_U16, true, (size_t)m->clusters, MODEL_SHAPE(m->texels));
}

static bool fit_mean(const void *context, size_t cluster, const float *values)
{
    return fields_fit(context, cluster, values);
}

static relume_status fit(struct fitting *f)
{
    struct fields fields;
    relume_status status = fields_start(&fields, f->out);
    if (!status)
        status = clusters_fit(f, CLUSTER, fit_mean, &fields);
    fields_end(&fields);
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
                const struct relume_btf_oriented_light *ambient, float rgb[3])
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
