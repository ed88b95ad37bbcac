// model_mean.c - one file that a line in `relume_btf_models` makes a model of the tool: every texel
// is its mean over all pictures (tests/cli/test_growing.sh)
#include "material/model/model.h"

extern const struct relume_btf_model model_mean;

enum { MEAN = 0 };

static void layout(relume_btf_fitted *m)
{
    model_add(m, "mean", NPY_HALF, true, 0, MODEL_SHAPE(m->texels, 3));
}

static void fit_texel(void *context, size_t texel, const float *values)
{
    relume_btf_fitted *m = context;
    const size_t pairs = model_pairs(m);
    for (size_t c = 0; c < 3; c++) {
        double sum = 0.0;
        for (size_t i = 0; i < pairs; i++)
            sum += (double)values[3 * i + c];
        model_halfs(m, MEAN)[3 * texel + c] = model_half(sum / (double)pairs);
    }
}

static relume_status fit(struct fitting *f)
{
    return btf_for_texels(f->btf, f->threads, f->log, "fitting", f->out, fit_texel);
}

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    for (size_t c = 0; c < 3; c++)
        rgb[c] = float_from_half(model_halfs(m, MEAN)[3 * at->texel + c]);
}

static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    (void)m;
    return (struct relume_btf_cost){.fetches = 1};
}

const struct relume_btf_model model_mean = {
    .name = "mean",
    .summary = "the mean over all pictures",
    .layout = layout,
    .fit = fit,
    .eval = eval,
    .cost = cost,
};
