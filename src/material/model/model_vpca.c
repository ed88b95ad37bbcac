// model_vpca.c - principal components of the pictures of each view (Sattler, Sarlette, Klein 2003):
//     BTF(x, v, l) ~ mean_v(x) + sum_i weight_i(v, l) E_i(x, v)
#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"
#include "material/btf/values.h"
#include "material/model/model.h"

#include <string.h>

enum { MEAN, TEXTURE, WEIGHT };
enum { BATCH = 1024 };  // values of a picture that are taken at once

static void layout(relume_btf_fitted *m)
{
    const size_t v = (size_t)m->views, k = (size_t)m->components;
    model_add(m, "mean", NPY_HALF, true, 0, MODEL_SHAPE(v, m->texels, 3));
    model_add(m, "texture", NPY_HALF, true, 0, MODEL_SHAPE(v, k, m->texels, 3));
    model_add(m, "weight", NPY_HALF, false, 0, MODEL_SHAPE(v, (size_t)m->lights, k));
}

struct vpca_fit {
    struct fitting *f;
    bool failed;  // set by any worker, read after all
};

// The scratch of one view.
struct view {
    int number, lights, count;
    size_t values;   // of a picture
    double *rows;    // [BATCH][lights]: values, mean removed
    double *gram;    // [lights][lights]
    double *vector;  // [count][lights]
    double *values_of;
    double longest;  // row, squared
    double scale;    // of textures, so that halfs hold them; weights make up for it
};

// Rows of `n` values from `first` on, and their means.
static void load(const relume_btf *btf, struct view *w, size_t first, size_t n, uint16_t *mean)
{
    for (int l = 0; l < w->lights; l++) {
        const uint16_t *p = relume_btf_picture(btf, w->number, l) + first;
        for (size_t i = 0; i < n; i++)
            w->rows[i * (size_t)w->lights + (size_t)l] = (double)float_from_half(p[i]);
    }
    for (size_t i = 0; i < n; i++) {
        double *row = w->rows + i * (size_t)w->lights, sum = 0.0;
        for (int l = 0; l < w->lights; l++)
            sum += row[l];
        mean[first + i] = half_from_float((float)(sum / w->lights));
        const double stored = (double)float_from_half(mean[first + i]);
        double squared = 0.0;
        for (int l = 0; l < w->lights; l++) {
            row[l] -= stored;
            squared += row[l] * row[l];
        }
        w->longest = fmax(w->longest, squared);
    }
}

static size_t batch(const struct view *w, size_t first)
{
    return w->values - first < BATCH ? w->values - first : BATCH;
}

// Textures are scores, in the units of the values (very bright ones scaled); weights are unit
// vectors over the lights.
static void project(struct view *w, size_t first, size_t n, uint16_t *texture)
{
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < w->count; k++) {
            const double *row = w->rows + i * (size_t)w->lights;
            const double *vector = w->vector + (size_t)k * (size_t)w->lights;
            double sum = 0.0;
            for (int l = 0; l < w->lights; l++)
                sum += row[l] * vector[l];
            texture[(size_t)k * w->values + first + i] = model_half(w->scale * sum);
        }
}

static bool solve(struct view *w, const struct fitting *f)
{
    relume_btf_fitted *m = f->out;
    const size_t number = (size_t)w->number, lights = (size_t)w->lights, count = (size_t)w->count;
    uint16_t *mean = model_halfs(m, MEAN) + number * w->values;
    uint16_t *texture = model_halfs(m, TEXTURE) + number * count * w->values;
    uint16_t *weight = model_halfs(m, WEIGHT) + number * lights * count;
    memset(w->gram, 0, lights * lights * sizeof *w->gram);
    for (size_t first = 0; first < w->values; first += BATCH) {
        load(f->btf, w, first, batch(w, first), mean);
        lsq_add_gram(w->gram, w->lights, w->rows, (int)batch(w, first));
    }
    if (!lsq_eigenvectors(w->gram, w->lights, w->count, w->values_of, w->vector))
        return false;
    for (w->scale = 1.0; w->scale * sqrt(w->longest) > 65504.0;)
        w->scale *= 0.5;  // an even power of two costs no digit
    for (size_t first = 0; first < w->values; first += BATCH) {
        load(f->btf, w, first, batch(w, first), mean);
        project(w, first, batch(w, first), texture);
    }
    for (size_t l = 0; l < lights; l++)
        for (size_t k = 0; k < count; k++)
            weight[l * count + k] = model_half(w->vector[k * lights + l] / w->scale);
    return true;
}

static void fit_view(void *context, size_t item, int worker)
{
    (void)worker;
    struct vpca_fit *work = context;
    const relume_btf_fitted *m = work->f->out;
    const size_t n = (size_t)m->lights, k = (size_t)m->components;
    struct view w = {
        .number = (int)item,
        .lights = m->lights,
        .count = m->components,
        .values = 3 * m->texels,
        .rows = mem_array(BATCH * n, sizeof *w.rows),
        .gram = mem_array(n * n, sizeof *w.gram),
        .vector = mem_array(k * n, sizeof *w.vector),
        .values_of = mem_array(k, sizeof *w.values_of),
    };
    if (!w.rows || !w.gram || !w.vector || !w.values_of || !solve(&w, work->f))
        __atomic_store_n(&work->failed, true, __ATOMIC_RELAXED);
    mem_free(w.rows);
    mem_free(w.gram);
    mem_free(w.vector);
    mem_free(w.values_of);
}

static relume_status fit(struct fitting *f)
{
    struct vpca_fit work = {f, false};
    thread_for(f->threads, (size_t)f->out->views, fit_view, &work);
    return work.failed ? RELUME_ENOMEM : RELUME_OK;
}

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    const size_t count = (size_t)m->components, view = (size_t)at->view, n = 3 * m->texels;
    const uint16_t *mean = model_halfs(m, MEAN) + view * n + 3 * at->texel;
    const uint16_t *texture = model_halfs(m, TEXTURE) + view * count * n + 3 * at->texel;
    const uint16_t *weight =
        model_halfs(m, WEIGHT) + (view * (size_t)m->lights + (size_t)at->light) * count;
    for (int c = 0; c < 3; c++)
        rgb[c] = float_from_half(mean[c]);
    for (size_t k = 0; k < count; k++) {
        const float w = float_from_half(weight[k]);
        for (int c = 0; c < 3; c++)
            rgb[c] += w * float_from_half(texture[k * n + (size_t)c]);
    }
}

// Weights of nine pairs, four at a time, are blended before the textures of three views are read.
static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    const int k = m->components, quads = (k + 3) / 4;
    return (struct relume_btf_cost){.ops = 3,
                                    .fetches = 2 + 3 * (1 + k),
                                    .light_ops = 9 * quads + 3 * k,
                                    .light_fetches = 2 + 9 * quads};
}

const struct relume_btf_model model_vpca = {
    .name = "vpca",
    .summary = "principal components of each view's pictures",
    .view_grid = true,
    .light_grid = true,
    .components = 4,
    .of_views = true,
    .layout = layout,
    .fit = fit,
    .eval = eval,
    .cost = cost,
};
