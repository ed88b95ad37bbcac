// model_bump.c - bump mapping with the mean BRDF of the sample: a colour and a normal a texel, and
// one table of view and light that is looked up in the frame of the normal. Normals come from the
// view nearest to the pole, by photometric stereo (Woodham 1980) without the darkest and brightest
// lights. Stereo needs what is seen, with n.l; and where values lack it, what the table says of the
// turned light is times that light's own cosine, not that of the plane.
#include "core/base/half.h"
#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "material/btf/values.h"
#include "material/model/model.h"

#include <string.h>

enum { COLOR, NORMAL, MEAN };
static const double DARK = 0.3, BRIGHT = 0.9;  // shares of the lights, by value, that are used
static const double LEAST_Z = 0.2;             // of a normal

static void layout(relume_btf_fitted *m)
{
    model_add(m, "color", NPY_HALF, true, 0, MODEL_SHAPE(m->texels, 3));
    model_add(m, "normal", NPY_HALF, true, 0, MODEL_SHAPE(m->texels, 3));
    model_add(m, "mean", NPY_HALF, false, 0, MODEL_SHAPE((size_t)m->views, (size_t)m->lights, 3));
}

struct bump_fit {
    relume_btf_fitted *m;
    int top_view;
    double *mean;  // [texels][3]
};

struct sample {
    double value;
    int light;
};

static int by_value(const void *a, const void *b)
{
    const struct sample *x = a, *y = b;
    if (x->value != y->value)
        return x->value < y->value ? -1 : 1;
    return x->light - y->light;
}

// Least squares of value = b . l; `list` is sorted.
static vec3 normal_of(const struct relume_btf_fitted *m, const struct sample *list)
{
    double gram[9] = {0.0}, right[3] = {0.0};
    for (int i = (int)(DARK * m->lights); i < (int)ceil(BRIGHT * m->lights); i++) {
        const vec3 l = m->light[list[i].light];
        const double row[3] = {l.x, l.y, l.z};
        for (int a = 0; a < 3; a++) {
            right[a] += row[a] * list[i].value;
            for (int b = 0; b < 3; b++)
                gram[3 * a + b] += row[a] * row[b];
        }
    }
    for (int a = 0; a < 3; a++)
        gram[4 * a] += 1e-6 * m->lights;
    if (!lsq_solve(gram, 3, right, 1))
        return vec3_of(0.0, 0.0, 1.0);
    const vec3 b = vec3_of(right[0], right[1], right[2]);
    const double length = vec3_length(b);
    if (!(length > 1e-9))
        return vec3_of(0.0, 0.0, 1.0);
    const vec3 n = vec3_scale(b, 1.0 / length);
    return vec3_unit(vec3_of(n.x, n.y, fmax(n.z, LEAST_Z)));
}

static void measure(void *context, size_t texel, const float *values)
{
    const struct bump_fit *w = context;
    const size_t pairs = model_pairs(w->m);
    double *mean = w->mean + 3 * texel;
    struct sample list[1024];
    const int lights = w->m->lights < 1024 ? w->m->lights : 1024;
    mean[0] = mean[1] = mean[2] = 0.0;
    for (size_t i = 0; i < pairs; i++)
        for (int c = 0; c < 3; c++)
            mean[c] += (double)values[3 * i + (size_t)c] / (double)pairs;
    const float *top = values + 3 * (size_t)w->top_view * (size_t)w->m->lights;
    for (int l = 0; l < lights; l++)
        list[l] = (struct sample){(double)(top[3 * l] + top[3 * l + 1] + top[3 * l + 2]) *
                                      (w->m->without_cosine ? w->m->light[l].z : 1.0),
                                  l};
    qsort(list, (size_t)lights, sizeof *list, by_value);
    const vec3 n = normal_of(w->m, list);
    const float normal[3] = {(float)n.x, (float)n.y, (float)n.z};
    for (int c = 0; c < 3; c++) {
        model_halfs(w->m, COLOR)[3 * texel + (size_t)c] = half_from_float((float)mean[c]);
        model_halfs(w->m, NORMAL)[3 * texel + (size_t)c] = half_from_float(normal[c]);
    }
}

// The mean of every picture over the mean of all.
static void average(const struct fitting *f, const double *mean)
{
    const relume_btf_fitted *m = f->out;
    double all[3] = {0.0, 0.0, 0.0};
    for (size_t i = 0; i < 3 * m->texels; i++)
        all[i % 3] += mean[i];
    for (int v = 0; v < m->views; v++)
        for (int l = 0; l < m->lights; l++) {
            const uint16_t *p = relume_btf_picture(f->btf, v, l);
            double sum[3] = {0.0, 0.0, 0.0};
            for (size_t i = 0; i < 3 * m->texels; i++)
                sum[i % 3] += (double)float_from_half(p[i]);
            uint16_t *to = model_halfs(m, MEAN) + 3 * ((size_t)v * (size_t)m->lights + (size_t)l);
            for (int c = 0; c < 3; c++)
                to[c] = half_from_float(all[c] > 0.0 ? (float)(sum[c] / all[c]) : 0.0f);
        }
}

static relume_status fit(struct fitting *f)
{
    relume_btf_fitted *m = f->out;
    struct bump_fit w = {m, 0, mem_array(3 * m->texels, sizeof *w.mean)};
    for (int v = 1; v < m->views; v++)
        w.top_view = m->view[v].z > m->view[w.top_view].z ? v : w.top_view;
    relume_status status =
        w.mean ? btf_for_texels(f->btf, f->threads, f->log, "fitting", &w, measure) : RELUME_ENOMEM;
    if (!status)
        average(f, w.mean);
    mem_free(w.mean);
    return status;
}

static const double LEAST_COSINE = 1e-6;

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    const uint16_t *color = model_halfs(m, COLOR) + 3 * at->texel;
    const uint16_t *normal = model_halfs(m, NORMAL) + 3 * at->texel;
    const vec3 n =
        vec3_unit(vec3_of((double)float_from_half(normal[0]), (double)float_from_half(normal[1]),
                          (double)float_from_half(normal[2])));
    const struct relume_direction_blend v =
        relume_direction_mesh_at(m->view_mesh, vec3_upright(at->v, n));
    const vec3 turned = vec3_upright(at->l, n);
    const struct relume_direction_blend l = relume_direction_mesh_at(m->light_mesh, turned);
    // What the table's value is times: the share that arrives below its lowest lights, or, where
    // values lack n.l, the cosine of the light on the turned plane over that on the plane, which
    // follows.
    const double scale =
        m->without_cosine ? fmax(turned.z, 0.0) / fmax(at->l.z, LEAST_COSINE) : l.rim / l.length;
    double sum[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < v.count; i++)
        for (int j = 0; j < l.count; j++) {
            const size_t pair = (size_t)v.index[i] * (size_t)m->lights + (size_t)l.index[j];
            for (int c = 0; c < 3; c++)
                sum[c] += v.weight[i] * l.weight[j] *
                          (double)float_from_half(model_halfs(m, MEAN)[3 * pair + (size_t)c]);
        }
    for (int c = 0; c < 3; c++)
        rgb[c] = float_from_half(color[c]) * (float)(scale * sum[c]);
}

// Eye and light turn with the normal; nine pairs of the table are blended.
static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    (void)m;
    return (struct relume_btf_cost){
        .ops = 4, .fetches = 2 + 2, .light_ops = 4 + 9 + 1, .light_fetches = 2 + 9};
}

const struct relume_btf_model model_bump = {
    .name = "bump",
    .summary = "a colour and a normal for each texel, one mean BRDF",
    .layout = layout,
    .fit = fit,
    .eval = eval,
    .cost = cost,
};
