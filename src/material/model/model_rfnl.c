// model_rfnl.c - reflectance fields with non-linear lobes for every texel and view (Meseth,
// Mueller, Klein 2003; thesis, Eq. 3.1)
#include "material/model/environment.h"
#include "material/model/fields.h"

static void layout(relume_btf_fitted *m)
{
    fields_layout(m, m->texels, true);
}

struct rfnl_fit {
    struct fields fields;
    bool failed;  // set by any worker, read after all
};

static void fit_texel(void *context, size_t texel, const float *values)
{
    struct rfnl_fit *w = context;
    if (!fields_fit(&w->fields, texel, values))
        __atomic_store_n(&w->failed, true, __ATOMIC_RELAXED);
}

static relume_status fit(struct fitting *f)
{
    struct rfnl_fit w = {.failed = false};
    relume_status status = fields_start(&w.fields, f->out);
    if (!status)
        status = btf_for_texels(f->btf, f->threads, f->log, "fitting", &w, fit_texel);
    fields_end(&w.fields);
    return status ? status : w.failed ? RELUME_ENOMEM : RELUME_OK;
}

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    fields_eval(m, at->texel, at, rgb);
}

static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    return fields_cost(m);
}

static void lit(const relume_btf_fitted *m, const struct model_at *at,
                const struct relume_btf_oriented_light *ambient, float rgb[3])
{
    fields_lit(m, at->texel, at, ambient, rgb);
}

const struct relume_btf_model model_rfnl = {
    .name = "rfnl",
    .summary = "cosine lobes of the light for each view",
    .view_grid = true,
    .lobes = 2,
    .layout = layout,
    .fit = fit,
    .eval = eval,
    .cost = cost,
    .lit = lit,
};
