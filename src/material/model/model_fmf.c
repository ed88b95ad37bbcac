// model_fmf.c - full matrix factorisation (Koudelka et al. 2003; Liu et al. 2004): one singular
// value decomposition of the matrix of texels by pairs of directions and colours
//     BTF(x, v, l) ~ sum_k weight_k(x) pattern_k(v, l)
#include "material/model/reduce.h"
#include "core/base/half.h"

enum { WEIGHT, PATTERN };

static void layout(relume_btf_fitted *m)
{
    const size_t k = (size_t)m->components;
    model_add(m, "weight", NPY_HALF, true, 0, MODEL_SHAPE(m->texels, k));
    model_add(m, "pattern", NPY_HALF, false, 0,
              MODEL_SHAPE(k, (size_t)m->views, (size_t)m->lights, 3));
}

static relume_status fit(struct fitting *f)
{
    const relume_btf_fitted *m = f->out;
    const size_t count = (size_t)m->components;
    struct reduced r;
    const relume_status status = reduce_make(&r, f, m->components);
    if (status)
        return status;
    // patterns of mean square 1: unit vectors of so many values would be lost among the halfs
    const float scale = sqrtf((float)r.values);
    const size_t found = (size_t)r.count;
    for (size_t i = 0; i < m->texels; i++)
        for (size_t k = 0; k < found; k++)
            model_halfs(m, WEIGHT)[i * count + k] = half_from_float(r.score[i * found + k] / scale);
    for (size_t i = 0; i < found * r.values; i++)
        model_halfs(m, PATTERN)[i] = half_from_float(r.basis[i] * scale);
    reduce_free(&r);
    return RELUME_OK;
}

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    const size_t pair = (size_t)at->view * (size_t)m->lights + (size_t)at->light;
    const uint16_t *weight = model_halfs(m, WEIGHT) + at->texel * (size_t)m->components;
    const uint16_t *pattern = model_halfs(m, PATTERN) + 3 * pair;
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    model_add_components(rgb, m, weight, pattern);
}

// Patterns of nine pairs.
static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    const int k = m->components;
    return (struct relume_btf_cost){
        .fetches = (k + 3) / 4 + 2, .light_ops = 9 * k, .light_fetches = 2 + 9 * k};
}

const struct relume_btf_model model_fmf = {
    .name = "fmf",
    .summary = "full matrix factorisation of all values",
    .view_grid = true,
    .light_grid = true,
    .components = 100,
    .layout = layout,
    .fit = fit,
    .eval = eval,
    .cost = cost,
};
