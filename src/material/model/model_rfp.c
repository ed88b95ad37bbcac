// model_rfp.c - a biquadratic polynomial of the light for each texel and view, the polynomial
// texture map of Malzbender, Gelb, Wolters (2001) for every measured view:
//     BTF(x, v, l) ~ a0 lx^2 + a1 ly^2 + a2 lx ly + a3 lx + a4 ly + a5
#include "core/base/memory.h"
#include "material/model/model.h"
#include "core/base/half.h"
#include "core/math/lsq.h"

#include <string.h>

enum { TERMS = 6, COEFFICIENT = 0 };
static const double RIDGE = 1e-9;  // of the mean eigenvalue: fewer than six lights determine less

static void terms(vec3 l, double out[TERMS])
{
    const double t[TERMS] = {l.x * l.x, l.y * l.y, l.x * l.y, l.x, l.y, 1.0};
    memcpy(out, t, sizeof t);
}

static void layout(relume_btf_fitted *m)
{
    model_add(m, "coefficient", NPY_HALF, true, 0,
              MODEL_SHAPE(m->texels, (size_t)m->views, TERMS, 3));
}

struct rfp_fit {
    relume_btf_fitted *m;
    double *solution;  // [lights][TERMS]: from samples to coefficients
};

static void fit_texel(void *context, size_t texel, const float *values)
{
    const struct rfp_fit *w = context;
    const size_t views = (size_t)w->m->views, lights = (size_t)w->m->lights;
    uint16_t *to = model_halfs(w->m, COEFFICIENT) + texel * views * TERMS * 3;
    for (size_t v = 0; v < views; v++, to += TERMS * 3) {
        double sum[TERMS][3] = {{0.0}};
        for (size_t l = 0; l < lights; l++, values += 3)
            for (int t = 0; t < TERMS; t++)
                for (int c = 0; c < 3; c++)
                    sum[t][c] += w->solution[l * TERMS + (size_t)t] * (double)values[c];
        for (int t = 0; t < TERMS; t++)
            for (int c = 0; c < 3; c++)
                to[3 * t + c] = model_half(sum[t][c]);
    }
}

// (T' T)^-1 T', transposed.
static bool solve(struct rfp_fit *w)
{
    const size_t lights = (size_t)w->m->lights;
    double gram[TERMS * TERMS] = {0.0}, trace = 0.0;
    for (size_t l = 0; l < lights; l++)
        terms(w->m->light[l], w->solution + l * TERMS);
    lsq_add_gram(gram, TERMS, w->solution, (int)lights);
    for (int t = 0; t < TERMS; t++)
        trace += gram[t * TERMS + t];
    for (int t = 0; t < TERMS; t++)
        gram[t * TERMS + t] += RIDGE * trace / TERMS;
    return lsq_solve(gram, TERMS, w->solution, (int)lights);
}

static relume_status fit(struct fitting *f)
{
    struct rfp_fit w = {f->out, mem_array((size_t)f->out->lights * TERMS, sizeof *w.solution)};
    relume_status status = w.solution && solve(&w) ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = btf_for_texels(f->btf, f->threads, f->log, "fitting", &w, fit_texel);
    mem_free(w.solution);
    return status;
}

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    const size_t slice = at->texel * (size_t)m->views + (size_t)at->view;
    const uint16_t *a = model_halfs(m, COEFFICIENT) + slice * TERMS * 3;
    double term[TERMS];
    terms(at->l, term);
    for (int c = 0; c < 3; c++) {
        double sum = 0.0;
        for (int t = 0; t < TERMS; t++)
            sum += term[t] * (double)float_from_half(a[3 * t + c]);
        rgb[c] = (float)sum;
    }
}

// Six terms, in colour, for three views.
static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    (void)m;
    return (struct relume_btf_cost){.fetches = 2 + 3 * TERMS, .light_ops = 3 + 3 * (TERMS + 1)};
}

const struct relume_btf_model model_rfp = {
    .name = "rfp",
    .summary = "a biquadratic polynomial of the light for each view",
    .view_grid = true,
    .layout = layout,
    .fit = fit,
    .eval = eval,
    .cost = cost,
};
