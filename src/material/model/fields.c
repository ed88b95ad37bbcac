// fields.c - fits and evaluates reflectance fields with non-linear lobes (thesis, Eq. 3.1)
#include "material/model/fields.h"

#include "core/base/half.h"
#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "core/math/luminance.h"
#include "material/model/ambient.h"
#include "material/model/environment.h"

#include <string.h>

enum { NEAR = 6 };
// Where a further lobe starts: as sharp as a dozen lights around the peak can resolve.
static const double START_N = 10.0;
// A lobe may stand this much over the brightest sample: peaks fall between lights.
static const double OVERSHOOT = 1.5;
// Of white, or of the brightest value where that is more: halfs stay far from overflow, also after
// lighting.
static const double MOST_ALBEDO = 64.0;
// Values from so dark to so bright are fitted as they are, others in units that bring them there.
static const double DARKEST = 1.0 / 64, BRIGHTEST = 8.0;
// What a fit without a floor must leave of the squared error to be taken: lobes that hold the matt
// part as well are further from their environment (btf_environment.h) than a floor is.
static const double MATT = 0.03;

void fields_layout(relume_btf_fitted *m, size_t entries, bool each)
{
    const size_t views = (size_t)m->views, lobes = (size_t)m->lobes;
    model_add(m, "diffuse", NPY_HALF, each, 0, MODEL_SHAPE(entries, 3));
    model_add(m, "specular", NPY_HALF, each, 0, MODEL_SHAPE(entries, views, 3));
    model_add(m, "lobe", NPY_FLOAT, each, 0, MODEL_SHAPE(entries, views, lobes, 4));
}

static bool is_among(const int *list, int n, int x)
{
    for (int i = 0; i < n; i++)
        if (list[i] == x)
            return true;
    return false;
}

static double cosine(const struct fields *s, int i, int j)
{
    const double *a = s->light[i], *b = s->light[j];
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void find_near(struct fields *s, int light, int n)
{
    int *near = s->near[light];
    for (int k = 0; k < NEAR; k++) {
        int best = -1;
        for (int i = 0; i < n; i++)
            if (i != light && !is_among(near, k, i) &&
                (best < 0 || cosine(s, i, light) > cosine(s, best, light)))
                best = i;
        near[k] = best < 0 ? near[0] : best;  // sets of fewer lights
    }
}

relume_status fields_start(struct fields *s, relume_btf_fitted *m)
{
    const size_t n = (size_t)m->lights;
    *s = (struct fields){.m = m};
    s->light = mem_array(n, sizeof *s->light);
    s->near = mem_array(n, sizeof *s->near);
    if (!s->light || !s->near)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        s->light[i][0] = m->light[i].x, s->light[i][1] = m->light[i].y;
        s->light[i][2] = m->light[i].z;
    }
    for (int i = 0; i < m->lights; i++)
        find_near(s, i, m->lights);
    lsq_add_gram(s->inverse, 3, s->light[0], m->lights);
    for (int c = 0; c < 3; c++)
        s->inverse[4 * c] += 1e-9 * (double)n;
    return lsq_invert(s->inverse, 3);
}

void fields_end(struct fields *s)
{
    mem_free(s->light);
    mem_free(s->near);
}

// ---------------------------------------------------------------- where lobes start

// The plane t . l that fits best, tipped up where it would light from below.
static struct lobe broad_start(const struct fields *s, const double *y)
{
    double right[3] = {0.0, 0.0, 0.0}, t[3];
    for (int i = 0; i < s->m->lights; i++)
        for (int c = 0; c < 3; c++)
            right[c] += y[i] * s->light[i][c];
    for (int c = 0; c < 3; c++)
        t[c] = s->inverse[3 * c] * right[0] + s->inverse[3 * c + 1] * right[1] +
               s->inverse[3 * c + 2] * right[2];
    t[2] = fmax(t[2], 1e-3);
    return (struct lobe){{t[0], t[1], t[2]}, 1.0};
}

// The principal direction of what is left: the light that stands highest over its neighbours.
static struct lobe peak_start(const struct fields *s, const double *rest)
{
    int best = 0;
    double most = -INFINITY;
    for (int i = 0; i < s->m->lights; i++) {
        double around = 0.0;
        for (int k = 0; k < NEAR; k++)
            around += rest[s->near[i][k]] / NEAR;
        if (rest[i] - around > most) {
            most = rest[i] - around;
            best = i;
        }
    }
    return lobe_along(s->light[best], START_N, rest[best]);
}

// ---------------------------------------------------------------- one entry

struct field_work {
    double *y, *rest;  // [lights]
    double *sum;       // [views][lights]: of lobes
    double top, unit;  // the brightest value; lobes are fitted to values over `unit`
};

// One entry as it is stored.
struct stored {
    uint16_t *diffuse, *specular;  // [3], [views][3]
    float *lobe;                   // [views][lobes][4]
    size_t speculars, lobes;       // how many numbers
};

static double fit_view(const struct fields *s, struct lobe *lobe, const struct field_work *w,
                       double top)
{
    const int n = s->m->lights, count = s->m->lobes;
    const struct lobe_samples samples = {(const double(*)[3])s->light, NULL, w->y, n};
    lobe[0] = broad_start(s, w->y);
    for (int j = 1; j < count; j++) {
        for (int i = 0; i < n; i++) {
            w->rest[i] = w->y[i];
            for (int k = 0; k < j; k++)
                w->rest[i] -= lobe_at(&lobe[k], s->light[i]);
        }
        lobe[j] = peak_start(s, w->rest);
    }
    const double error = lobes_fit(lobe, count, &samples);
    for (int j = 0; j < count; j++)
        lobe_limit(&lobe[j], OVERSHOOT * top);
    return error;
}

// What every view shows at least, on average: where rho_d starts.
static double pedestal(const float *values, int views, int lights)
{
    double sum = 0.0;
    for (int v = 0; v < views; v++) {
        double least = INFINITY;
        for (int l = 0; l < lights; l++)
            least = fmin(least, luminance_709(values + 3 * (v * lights + l)));
        sum += least;
    }
    return sum / views;
}

// Lobes as they are stored, back in the units of the values.
static void store_lobes(float *to, struct lobe *lobe, int count, double unit)
{
    for (int j = 0; j < count; j++, to += 4) {
        const double length = pow(unit, 1.0 / lobe[j].n);
        for (int c = 0; c < 3; c++)
            lobe[j].t[c] = to[c] = (float)(length * lobe[j].t[c]);
        lobe[j].n = to[3] = (float)lobe[j].n;
    }
}

static double clipped(double x, double brightest)
{
    return fmin(fmax(x, 0.0), MOST_ALBEDO * fmax(brightest, 1.0));
}

// Both rho of one channel: the linear least squares over all views, with each rho_v eliminated.
// Returns the squared error of what is stored.
static double solve_albedo(const struct fields *s, const struct stored *to,
                           const struct field_work *w, const float *values, size_t channel)
{
    const size_t views = (size_t)s->m->views, lights = (size_t)s->m->lights;
    double over = 0.0, under = 0.0, error = 0.0;
    for (size_t v = 0; v < views; v++) {
        double s1 = 0.0, s2 = 0.0, c1 = 0.0, sc = 0.0;
        for (size_t l = 0; l < lights; l++) {
            const double lobe = w->sum[v * lights + l];
            const double value = (double)values[3 * (v * lights + l) + channel];
            s1 += lobe, s2 += lobe * lobe, c1 += value, sc += lobe * value;
        }
        const double share = s2 > 1e-20 ? s1 / s2 : 0.0;
        over += c1 - share * sc;
        under += (double)lights - share * s1;
    }
    to->diffuse[channel] = model_half(clipped(under > 1e-9 ? over / under : 0.0, w->top));
    const double rho_d = (double)float_from_half(to->diffuse[channel]);
    for (size_t v = 0; v < views; v++) {
        double s2 = 0.0, sc = 0.0, c2 = 0.0;
        for (size_t l = 0; l < lights; l++) {
            const double lobe = w->sum[v * lights + l];
            const double rest = (double)values[3 * (v * lights + l) + channel] - rho_d;
            s2 += lobe * lobe, sc += lobe * rest, c2 += rest * rest;
        }
        uint16_t *specular = to->specular + 3 * v + channel;
        *specular = model_half(clipped(s2 > 1e-20 ? sc / s2 : 0.0, 1.0));
        const double rho_v = (double)float_from_half(*specular);
        error += c2 - 2.0 * rho_v * sc + rho_v * rho_v * s2;
    }
    return error;
}

// What view `v` shows over `floor_value`; returns the greatest.
static double take_view(const struct fields *s, int v, double floor_value, const float *values,
                        struct field_work *w)
{
    double top = 0.0;
    for (int l = 0; l < s->m->lights; l++) {
        w->y[l] = (luminance_709(values + 3 * (v * s->m->lights + l)) - floor_value) / w->unit;
        top = fmax(top, w->y[l]);
    }
    return top;
}

// Whether lobes alone fit one view far better than lobes on a floor: a look at one view of many,
// which spares most entries the second fit.
static bool seems_matt(const struct fields *s, double floor_value, const float *values,
                       struct field_work *w)
{
    struct lobe lobe[MODEL_LOBES];
    double error[2];
    for (int i = 0; i < 2; i++)
        error[i] = fit_view(s, lobe, w, take_view(s, 0, i ? 0.0 : floor_value, values, w));
    return error[1] < MATT * error[0];
}

// Lobes on `floor_value`, then the colours; returns the squared error.
static double fit_on(const struct fields *s, const struct stored *to, double floor_value,
                     const float *values, struct field_work *w)
{
    const int views = s->m->views, lights = s->m->lights, count = s->m->lobes;
    float *next = to->lobe;
    for (int v = 0; v < views; v++, next += 4 * count) {
        struct lobe lobe[MODEL_LOBES];
        const double top = take_view(s, v, floor_value, values, w);
        fit_view(s, lobe, w, top);
        store_lobes(next, lobe, count, w->unit);
        for (int l = 0; l < lights; l++) {
            double *sum = &w->sum[v * lights + l];
            *sum = 0.0;
            for (int j = 0; j < count; j++)
                *sum += lobe_at(&lobe[j], s->light[l]);
        }
    }
    double error = 0.0;
    for (size_t c = 0; c < 3; c++)
        error += solve_albedo(s, to, w, values, c);
    return error;
}

static void copy(const struct stored *to, const struct stored *from)
{
    memcpy(to->diffuse, from->diffuse, 3 * sizeof *to->diffuse);
    memcpy(to->specular, from->specular, to->speculars * sizeof *to->specular);
    memcpy(to->lobe, from->lobe, to->lobes * sizeof *to->lobe);
}

// What is darkest in every view may be a floor that lobes stand on, or, as where light grazes a
// matt surface, part of the lobes. `spare` is overwritten.
static void fit_entry(const struct fields *s, const struct stored *to, const struct stored *spare,
                      const float *values, struct field_work *w)
{
    const int views = s->m->views, lights = s->m->lights;
    const double floor_value = pedestal(values, views, lights);
    w->top = 0.0;
    for (int i = 0; i < views * lights; i++)
        w->top = fmax(w->top, luminance_709(values + 3 * i));
    w->unit = w->top > BRIGHTEST                 ? w->top / BRIGHTEST
              : w->top > 0.0 && w->top < DARKEST ? w->top / DARKEST
                                                 : 1.0;
    const double error = fit_on(s, to, floor_value, values, w);
    if (seems_matt(s, floor_value, values, w) && fit_on(s, spare, 0.0, values, w) < MATT * error)
        copy(to, spare);
}

static struct stored stored_at(const struct fields *s, size_t entry)
{
    const size_t views = (size_t)s->m->views, lobes = 4 * views * (size_t)s->m->lobes;
    return (struct stored){
        .diffuse = model_halfs(s->m, FIELD_DIFFUSE) + 3 * entry,
        .specular = model_halfs(s->m, FIELD_SPECULAR) + 3 * entry * views,
        .lobe = model_floats(s->m, FIELD_LOBE) + entry * lobes,
        .speculars = 3 * views,
        .lobes = lobes,
    };
}

bool fields_fit(const struct fields *s, size_t entry, const float *values)
{
    const size_t lights = (size_t)s->m->lights;
    const struct stored to = stored_at(s, entry);
    double *scratch = mem_array(lights * ((size_t)s->m->views + 2), sizeof *scratch);
    uint16_t *halfs = mem_array(3 + to.speculars, sizeof *halfs);
    struct stored spare = to;
    spare.diffuse = halfs;
    spare.lobe = mem_array(to.lobes, sizeof *spare.lobe);
    const bool good = scratch && halfs && spare.lobe;
    if (good) {
        struct field_work w = {.y = scratch, .rest = scratch + lights, .sum = scratch + 2 * lights};
        spare.specular = halfs + 3;
        fit_entry(s, &to, &spare, values, &w);
    }
    mem_free(scratch);
    mem_free(halfs);
    mem_free(spare.lobe);
    return good;
}

void fields_eval(const relume_btf_fitted *m, size_t entry, const struct model_at *at, float rgb[3])
{
    const size_t slice = entry * (size_t)m->views + (size_t)at->view;
    const float *lobe = model_floats(m, FIELD_LOBE) + slice * (size_t)m->lobes * 4;
    const uint16_t *diffuse = model_halfs(m, FIELD_DIFFUSE) + 3 * entry;
    const uint16_t *specular = model_halfs(m, FIELD_SPECULAR) + 3 * slice;
    float sum = 0.0f;
    for (int j = 0; j < m->lobes; j++, lobe += 4) {
        const float s =
            lobe[0] * (float)at->l.x + lobe[1] * (float)at->l.y + lobe[2] * (float)at->l.z;
        sum += s > 1e-9f ? expf(lobe[3] * logf(s)) : 0.0f;
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = float_from_half(diffuse[c]) + float_from_half(specular[c]) * sum;
}

struct relume_btf_cost fields_cost(const relume_btf_fitted *m)
{
    return (struct relume_btf_cost){
        .ops = 1, .fetches = 2 + 1 + 3 * (1 + m->lobes), .light_ops = 3 * (1 + 3 * m->lobes)};
}

void fields_lit(const relume_btf_fitted *m, size_t entry, const struct model_at *at,
                const struct relume_btf_oriented_light *ambient, float rgb[3])
{
    const size_t slice = entry * (size_t)m->views + (size_t)at->view;
    const float *lobe = model_floats(m, FIELD_LOBE) + slice * (size_t)m->lobes * 4;
    const uint16_t *diffuse = model_halfs(m, FIELD_DIFFUSE) + 3 * entry;
    const uint16_t *specular = model_halfs(m, FIELD_SPECULAR) + 3 * slice;
    float even[3], sum[3] = {0.0f, 0.0f, 0.0f};
    ambient_even(ambient, m->without_cosine, even);
    for (int j = 0; j < m->lobes; j++, lobe += 4) {
        float one[3];
        ambient_lobe(ambient, lobe, lobe[3], m->without_cosine, one);
        for (int c = 0; c < 3; c++)
            sum[c] += one[c];
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = float_from_half(diffuse[c]) * even[c] + float_from_half(specular[c]) * sum[c];
}
