// model_table.c - the measured values themselves as a model: what takes models takes BTFs
#include "core/base/half.h"
#include "material/btf/values.h"
#include "material/model/model.h"

static void layout(relume_btf_fitted *m)
{
    (void)m;
}

static relume_status fit(struct fitting *f)
{
    f->out->table = f->btf;
    return RELUME_OK;
}

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    const uint16_t *p = relume_btf_picture(m->table, at->view, at->light) + 3 * at->texel;
    for (int c = 0; c < 3; c++)
        rgb[c] = float_from_half(p[c]);
}

// Nine values, weighed.
static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    (void)m;
    return (struct relume_btf_cost){.fetches = 2, .light_ops = 9, .light_fetches = 2 + 9};
}

const struct relume_btf_model model_table = {
    .name = "table",
    .summary = "all measured values",
    .view_grid = true,
    .light_grid = true,
    .layout = layout,
    .fit = fit,
    .eval = eval,
    .cost = cost,
};
