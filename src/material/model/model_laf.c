// model_laf.c - Lafortune lobes for each texel (McAllister, Lastra, Heidrich 2002)
//     BTF(x, v, l) ~ rho_d(x) + sum_j rho_j(x) s_j,   s_j = (Cx vx lx + Cy vy ly + Cz vz lz)^n
// and with a factor for each texel and view (Daubert et al. 2001)
//     BTF(x, v, l) ~ T(x, v) (rho_d(x) + sum_j rho_j(x) s_j)
// (2003 paper, Eqs. 2 to 4). Lobes and T are of luminance, the rho give the colour. The right sides
// are BRDFs: where values include n.l, they are multiplied by it, else not even a white Lambertian
// surface could be fitted.
#include "core/base/half.h"
#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "core/math/luminance.h"
#include "core/math/sort.h"
#include "material/model/ambient.h"
#include "material/model/environment.h"
#include "material/model/lobes.h"

#include <string.h>

enum { DIFFUSE, SPECULAR, LOBE, FACTOR };
enum { UNKNOWNS = MODEL_LOBES + 1, ROUNDS = 2 };
// Pairs of directions that the lobes are fitted to, at most: so many decide four numbers well.
enum { FITTED_PAIRS = 2187 };
// The share of pairs that show no more than the Lambertian part.
static const double DIFFUSE_RANK = 0.25;
// Values up to this are fitted as they are, brighter ones in units that bring them there.
static const double BRIGHTEST = 8.0;
static const double MOST_ALBEDO = 64.0, MOST_FACTOR = 64.0;  // albedos: over `unit`

static void layout(relume_btf_fitted *m)
{
    const size_t n = m->texels, lobes = (size_t)m->lobes;
    model_add(m, "diffuse", NPY_HALF, true, 0, MODEL_SHAPE(n, 3));
    model_add(m, "specular", NPY_HALF, true, 0, MODEL_SHAPE(n, lobes, 3));
    model_add(m, "lobe", NPY_HALF, true, 0, MODEL_SHAPE(n, lobes, 4));
}

static void layout_scaled(relume_btf_fitted *m)
{
    layout(m);
    model_add(m, "factor", NPY_FLOAT, true, 0, MODEL_SHAPE(m->texels, (size_t)m->views));
}

struct laf_fit {
    relume_btf_fitted *m;
    bool scaled;
    double (*product)[3];  // [pairs]: v * l by components
    double *cosine;        // [pairs]: n.l, or 1 where values are without it
    double (*fitted)[3];   // [fitted_count]: those that the lobes are fitted to
    double *fitted_cosine;
    size_t stride, fitted_count;
    bool failed;  // set by any worker, read after all
};

// What one texel needs.
struct texel {
    double *y, *rest;            // [fitted_count]
    double *lobe;                // [pairs][lobes]: values
    double *factor;              // [views]
    double unit;                 // lobes are fitted to values over this
    double albedo[3][UNKNOWNS];  // of each colour: rho_d, rho_j
};

// What most pairs reach is treated as Lambertian; lobes add to it.
static void subtract_diffuse(const struct laf_fit *w, struct texel *s)
{
    const size_t n = w->fitted_count;
    for (size_t i = 0; i < n; i++)
        s->rest[i] = s->y[i] / w->fitted_cosine[i];
    sort_doubles(s->rest, n);
    const double diffuse = s->rest[(size_t)(DIFFUSE_RANK * (double)n)];
    for (size_t i = 0; i < n; i++) {
        s->y[i] -= diffuse * w->fitted_cosine[i];
        s->rest[i] = s->y[i];
    }
}

// The lobe of a few usual ones that takes most from the rest; it is subtracted from it.
static struct lobe start(const struct laf_fit *w, double *rest)
{
    static const struct lobe usual[] = {
        {{-0.577, -0.577, 0.577}, 3.0},  {{-0.577, -0.577, 0.577}, 10.0},
        {{-0.577, -0.577, 0.577}, 40.0}, {{0.577, 0.577, 0.577}, 3.0},
        {{0.577, 0.577, 0.577}, 10.0},   {{0.1, 0.1, 0.99}, 1.0},
        {{0.1, 0.1, 0.99}, 4.0}};
    struct lobe best = usual[0];
    double most = 0.0;
    for (size_t k = 0; k < sizeof usual / sizeof *usual; k++) {
        // in units of sqrt(3), so that the mirror's peak is 1 at every angle
        const struct lobe lobe = lobe_along(
            (double[3]){1.732 * usual[k].t[0], 1.732 * usual[k].t[1], 1.732 * usual[k].t[2]},
            usual[k].n, 1.0);
        double both = 0.0, own = 0.0;
        for (size_t i = 0; i < w->fitted_count; i++) {
            const double value = w->fitted_cosine[i] * lobe_at(&lobe, w->fitted[i]);
            both += value * rest[i];
            own += value * value;
        }
        if (!(both > 0.0) || both * both / own <= most)
            continue;
        most = both * both / own;
        best = lobe_along(lobe.t, lobe.n, both / own);
    }
    for (size_t i = 0; i < w->fitted_count; i++)
        rest[i] -= w->fitted_cosine[i] * lobe_at(&best, w->fitted[i]);
    return best;
}

static void fit_lobes(const struct laf_fit *w, size_t texel, const float *values, struct texel *s)
{
    const int count = w->m->lobes;
    struct lobe lobe[MODEL_LOBES];
    double top = 0.0;
    for (size_t i = 0; i < w->fitted_count; i++) {
        s->y[i] = luminance_709(values + 3 * i * w->stride);
        top = fmax(top, s->y[i]);
    }
    s->unit = fmax(top / BRIGHTEST, 1.0);
    for (size_t i = 0; i < w->fitted_count; i++)
        s->y[i] /= s->unit;
    subtract_diffuse(w, s);
    const struct lobe_samples samples = {(const double(*)[3])w->fitted, w->fitted_cosine, s->y,
                                         (int)w->fitted_count};
    for (int j = 0; j < count; j++)
        lobe[j] = start(w, s->rest);
    lobes_fit(lobe, count, &samples);
    uint16_t *to = model_halfs(w->m, LOBE) + texel * (size_t)count * 4;
    for (int j = 0; j < count; j++, to += 4) {
        for (int c = 0; c < 3; c++)
            to[c] = half_from_float((float)lobe[j].t[c]);
        to[3] = half_from_float((float)lobe[j].n);
        for (int c = 0; c < 3; c++)
            lobe[j].t[c] = (double)float_from_half(to[c]);
        lobe[j].n = (double)float_from_half(to[3]);
    }
    for (size_t i = 0; i < model_pairs(w->m); i++)
        for (int j = 0; j < count; j++)
            s->lobe[i * (size_t)count + (size_t)j] = lobe_at(&lobe[j], w->product[i]);
}

// The colours, by least squares under the factors as they are.
static bool fit_albedo(const struct laf_fit *w, const float *values, struct texel *s)
{
    const int n = w->m->lobes + 1;
    double gram[UNKNOWNS * UNKNOWNS] = {0.0}, right[3 * UNKNOWNS] = {0.0}, trace = 0.0;
    for (size_t i = 0; i < model_pairs(w->m); i++) {
        const double factor = w->cosine[i] * s->factor[i / (size_t)w->m->lights];
        double row[UNKNOWNS] = {factor};
        for (int j = 1; j < n; j++)
            row[j] = factor * s->lobe[i * (size_t)(n - 1) + (size_t)(j - 1)];
        for (int a = 0; a < n; a++) {
            for (int b = 0; b <= a; b++)
                gram[a * n + b] += row[a] * row[b];
            for (int c = 0; c < 3; c++)
                right[c * n + a] += row[a] * (double)values[3 * i + (size_t)c];
        }
    }
    for (int a = 0; a < n; a++)
        trace += gram[a * n + a];
    for (int a = 0; a < n; a++)
        gram[a * n + a] += 1e-9 * trace + 1e-30;
    if (!lsq_solve(gram, n, right, 3))
        return false;
    for (int c = 0; c < 3; c++)
        for (int a = 0; a < n; a++)
            s->albedo[c][a] =
                s->unit * fmin(fmax(right[c * n + a] / s->unit, -MOST_ALBEDO), MOST_ALBEDO);
    return true;
}

// The best factor of each view for the colours as they are.
static void fit_factors(const struct laf_fit *w, const float *values, struct texel *s)
{
    const size_t lights = (size_t)w->m->lights, lobes = (size_t)w->m->lobes;
    for (size_t v = 0; v < (size_t)w->m->views; v++) {
        double both = 0.0, own = 0.0;
        for (size_t i = v * lights; i < (v + 1) * lights; i++)
            for (int c = 0; c < 3; c++) {
                double model = s->albedo[c][0];
                for (size_t j = 0; j < lobes; j++)
                    model += s->albedo[c][j + 1] * s->lobe[i * lobes + j];
                model *= w->cosine[i];
                both += model * (double)values[3 * i + (size_t)c];
                own += model * model;
            }
        s->factor[v] = own > 1e-20 ? fmin(fmax(both / own, 0.0), MOST_FACTOR) : 1.0;
    }
}

static bool fit_colors(const struct laf_fit *w, const float *values, struct texel *s)
{
    for (int v = 0; v < w->m->views; v++)
        s->factor[v] = 1.0;
    bool good = fit_albedo(w, values, s);
    for (int round = 0; round < ROUNDS && good && w->scaled; round++) {
        fit_factors(w, values, s);
        good = fit_albedo(w, values, s);
    }
    return good;
}

static void store(const struct laf_fit *w, size_t texel, const struct texel *s)
{
    const size_t lobes = (size_t)w->m->lobes, views = (size_t)w->m->views;
    for (size_t c = 0; c < 3; c++) {
        model_halfs(w->m, DIFFUSE)[3 * texel + c] = model_half(s->albedo[c][0]);
        for (size_t j = 0; j < lobes; j++)
            model_halfs(w->m, SPECULAR)[3 * (texel * lobes + j) + c] =
                model_half(s->albedo[c][j + 1]);
    }
    for (size_t v = 0; v < views && w->scaled; v++)
        model_floats(w->m, FACTOR)[texel * views + v] = (float)s->factor[v];
}

static void fit_texel(void *context, size_t texel, const float *values)
{
    struct laf_fit *w = context;
    const size_t pairs = model_pairs(w->m);
    struct texel s = {
        .y = mem_array(w->fitted_count, sizeof *s.y),
        .rest = mem_array(w->fitted_count, sizeof *s.rest),
        .lobe = mem_array(pairs * (size_t)w->m->lobes, sizeof *s.lobe),
        .factor = mem_array((size_t)w->m->views, sizeof *s.factor),
    };
    bool good = s.y && s.rest && s.lobe && s.factor;
    if (good) {
        fit_lobes(w, texel, values, &s);
        good = fit_colors(w, values, &s);
    }
    if (good)
        store(w, texel, &s);
    else
        __atomic_store_n(&w->failed, true, __ATOMIC_RELAXED);
    mem_free(s.y);
    mem_free(s.rest);
    mem_free(s.lobe);
    mem_free(s.factor);
}

static relume_status fit_all(struct fitting *f, bool scaled)
{
    relume_btf_fitted *m = f->out;
    const size_t pairs = model_pairs(m), lights = (size_t)m->lights;
    struct laf_fit w = {.m = m, .scaled = scaled};
    // odd strides come to every light, whatever the size of the set
    for (w.stride = 1; (pairs + w.stride - 1) / w.stride > FITTED_PAIRS || w.stride % 2 == 0;)
        w.stride++;
    w.fitted_count = (pairs + w.stride - 1) / w.stride;
    w.product = mem_array(pairs, sizeof *w.product);
    w.cosine = mem_array(pairs, sizeof *w.cosine);
    w.fitted = mem_array(w.fitted_count, sizeof *w.fitted);
    w.fitted_cosine = mem_array(w.fitted_count, sizeof *w.fitted_cosine);
    const bool allocated = w.product && w.cosine && w.fitted && w.fitted_cosine;
    relume_status status = allocated ? RELUME_OK : RELUME_ENOMEM;
    for (size_t i = 0; i < pairs && !status; i++) {
        const vec3 v = m->view[i / lights], l = m->light[i % lights];
        const double product[3] = {v.x * l.x, v.y * l.y, v.z * l.z};
        memcpy(w.product[i], product, sizeof product);
        w.cosine[i] = m->without_cosine ? 1.0 : l.z;
        if (i % w.stride)
            continue;
        memcpy(w.fitted[i / w.stride], product, sizeof product);
        w.fitted_cosine[i / w.stride] = w.cosine[i];
    }
    if (!status)
        status = btf_for_texels(f->btf, f->threads, f->log, "fitting", &w, fit_texel);
    mem_free(w.product);
    mem_free(w.cosine);
    mem_free(w.fitted);
    mem_free(w.fitted_cosine);
    return status ? status : w.failed ? RELUME_ENOMEM : RELUME_OK;
}

static relume_status fit(struct fitting *f)
{
    return fit_all(f, false);
}

static relume_status fit_scaled(struct fitting *f)
{
    return fit_all(f, true);
}

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    const float product[3] = {(float)(at->v.x * at->l.x), (float)(at->v.y * at->l.y),
                              (float)(at->v.z * at->l.z)};
    const size_t lobes = (size_t)m->lobes;
    const uint16_t *diffuse = model_halfs(m, DIFFUSE) + 3 * at->texel;
    const uint16_t *specular = model_halfs(m, SPECULAR) + 3 * at->texel * lobes;
    const uint16_t *lobe = model_halfs(m, LOBE) + 4 * at->texel * lobes;
    for (int c = 0; c < 3; c++)
        rgb[c] = float_from_half(diffuse[c]);
    for (size_t j = 0; j < lobes; j++, lobe += 4, specular += 3) {
        float s = 0.0f;
        for (int c = 0; c < 3; c++)
            s += float_from_half(lobe[c]) * product[c];
        if (s <= 1e-9f)
            continue;
        const float value = expf(float_from_half(lobe[3]) * logf(s));
        for (int c = 0; c < 3; c++)
            rgb[c] += float_from_half(specular[c]) * value;
    }
    for (int c = 0; c < 3 && !m->without_cosine; c++)
        rgb[c] *= (float)at->l.z;
}

// Views are measured ones here, their factors are blended.
static void eval_scaled(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    const float factor = model_floats(m, FACTOR)[at->texel * (size_t)m->views + (size_t)at->view];
    eval(m, at, rgb);
    for (int c = 0; c < 3; c++)
        rgb[c] *= factor;
}

// For each lobe a scalar product, a power, its colour; then n.l.
static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    return (struct relume_btf_cost){.fetches = 1 + 2 * m->lobes, .light_ops = 2 + 3 * m->lobes};
}

// And three factors, blended.
static struct relume_btf_cost cost_scaled(const relume_btf_fitted *m)
{
    struct relume_btf_cost both = cost(m);
    both.ops += 3, both.fetches += 2 + 3, both.light_ops++;
    return both;
}

// For one view a Lafortune lobe is a cosine lobe of the light; all of the sum is times n.l.
static void lit(const relume_btf_fitted *m, const struct model_at *at,
                const struct relume_btf_oriented_light *ambient, float rgb[3])
{
    const size_t lobes = (size_t)m->lobes;
    const uint16_t *diffuse = model_halfs(m, DIFFUSE) + 3 * at->texel;
    const uint16_t *specular = model_halfs(m, SPECULAR) + 3 * at->texel * lobes;
    const uint16_t *lobe = model_halfs(m, LOBE) + 4 * at->texel * lobes;
    ambient_even(ambient, true, rgb);
    for (int c = 0; c < 3; c++)
        rgb[c] *= float_from_half(diffuse[c]);
    for (size_t j = 0; j < lobes; j++, lobe += 4, specular += 3) {
        const float t[3] = {float_from_half(lobe[0]) * (float)at->v.x,
                            float_from_half(lobe[1]) * (float)at->v.y,
                            float_from_half(lobe[2]) * (float)at->v.z};
        float one[3];
        ambient_lobe(ambient, t, float_from_half(lobe[3]), true, one);
        for (int c = 0; c < 3; c++)
            rgb[c] += float_from_half(specular[c]) * one[c];
    }
}

static void lit_scaled(const relume_btf_fitted *m, const struct model_at *at,
                       const struct relume_btf_oriented_light *ambient, float rgb[3])
{
    const float factor = model_floats(m, FACTOR)[at->texel * (size_t)m->views + (size_t)at->view];
    lit(m, at, ambient, rgb);
    for (int c = 0; c < 3; c++)
        rgb[c] *= factor;
}

const struct relume_btf_model model_laf = {
    .name = "laf",
    .summary = "Lafortune lobes for each texel",
    .lobes = 2,
    .lobes_times_cosine = true,
    .layout = layout,
    .fit = fit,
    .eval = eval,
    .cost = cost,
    .lit = lit,
};

const struct relume_btf_model model_slaf = {
    .name = "slaf",
    .summary = "Lafortune lobes and a factor for each view",
    .view_grid = true,
    .lobes = 2,
    .lobes_times_cosine = true,
    .layout = layout_scaled,
    .fit = fit_scaled,
    .eval = eval_scaled,
    .cost = cost_scaled,
    .lit = lit_scaled,
};
