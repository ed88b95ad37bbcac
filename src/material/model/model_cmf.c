// model_cmf.c - clusters of apparent BRDFs as products of positive functions of two numbers, in the
// manner of the chained matrix factorisation of Suykens, vom Berge, Lagae, Dutre (2003):
//     BTF(x, v, l) ~ V_c(v) L_c(l) H_c(h) D_c(d),   c = cluster(x)
// V and L are known at the measured directions; h is the half vector and d the light in a frame
// that has h upright (Rusinkiewicz 1998, but turned the shortest way, so that d is steady where h
// is at the pole); H and D are maps of x and y, looked up bilinearly.
//
// The links of the chain are fitted one after the other, each to what those before it leave, and
// then again in turn. Each step is the multiplicative one of Lee and Seung (2001), which keeps
// factors positive and never raises the squared error. Not the logarithms are fitted, as McCool,
// Ang, Ahmad (2001) do: shadows are zeros.
#include "core/base/memory.h"
#include "material/model/reduce.h"
#include "core/base/half.h"

#include <string.h>

enum { FACTOR, CLUSTER };
enum { SIDE = 15, CELLS = SIDE * SIDE };  // of a map; a middle cell stands at the pole
enum { ROUNDS = 24 };
// Maps have a mean of 1; what the data does not hold stays below.
static const float MOST_FACTOR = 16.0f;
static const float TINY = 1e-12f;

// Entries of one cluster: V, L, H, D, each in colour.
static size_t entries(const relume_btf_fitted *m)
{
    return (size_t)m->views + (size_t)m->lights + 2 * CELLS;
}

static void layout(relume_btf_fitted *m)
{
    const size_t c = (size_t)m->clusters;
    model_add(m, "factor", NPY_HALF, false, 0, MODEL_SHAPE(c, entries(m), 3));
    model_add(m, "cluster", NPY_U16, true, c, MODEL_SHAPE(m->texels));
}

// ---------------------------------------------------------------- places in maps

struct place {
    uint16_t cell[4];
    float weight[4];
};

// Bilinear in the x and y of a unit vector.
static struct place place_of(vec3 d)
{
    const double s = fmin(fmax(0.5 * (d.x + 1.0), 0.0), 1.0) * (SIDE - 1);
    const double t = fmin(fmax(0.5 * (d.y + 1.0), 0.0), 1.0) * (SIDE - 1);
    const int i = (int)fmin(s, SIDE - 2), j = (int)fmin(t, SIDE - 2);
    const double a = s - i, b = t - j;
    const int cell = j * SIDE + i;
    return (struct place){
        .cell = {(uint16_t)cell, (uint16_t)(cell + 1), (uint16_t)(cell + SIDE),
                 (uint16_t)(cell + SIDE + 1)},
        .weight = {(float)((1 - a) * (1 - b)), (float)(a * (1 - b)), (float)((1 - a) * b),
                   (float)(a * b)},
    };
}

static void places_of(vec3 v, vec3 l, struct place *half, struct place *difference)
{
    const vec3 h = vec3_unit(vec3_add(v, l));
    *half = place_of(h);
    *difference = place_of(vec3_upright(l, h));
}

static float map_at(const float *map, const struct place *p, int taps)
{
    float sum = 0.0f;
    for (int k = 0; k < taps; k++)
        sum += p->weight[k] * map[3 * p->cell[k]];
    return sum;
}

// ---------------------------------------------------------------- one colour of one cluster

struct cmf_fit {
    relume_btf_fitted *m;
    struct place *half, *difference;  // [pairs]
};

enum link { VIEW, LIGHT, HALF, DIFFERENCE, LINKS };

struct chain {
    const struct cmf_fit *w;
    const float *value;    // [pairs][3], from this colour on
    float *factor;         // [entries][3], from this colour on
    float *map[LINKS];     // into `factor`
    size_t size[LINKS];    // entries
    float *product;        // [pairs]
    float *above, *under;  // [entries of the largest link]
};

// What a link is looked up by: one entry of V and L, four of H and D.
static struct place place_in(const struct chain *s, enum link link, size_t pair)
{
    const size_t lights = s->size[LIGHT];
    const size_t entry = link == VIEW ? pair / lights : pair % lights;
    if (link == HALF)
        return s->w->half[pair];
    if (link == DIFFERENCE)
        return s->w->difference[pair];
    return (struct place){.cell = {(uint16_t)entry}, .weight = {1.0f}};
}

// One multiplicative step of one link; `product` follows.
static void improve(struct chain *s, enum link link)
{
    const size_t pairs = s->size[VIEW] * s->size[LIGHT];
    const int taps = link == VIEW || link == LIGHT ? 1 : 4;
    float *map = s->map[link];
    memset(s->above, 0, s->size[link] * sizeof *s->above);
    memset(s->under, 0, s->size[link] * sizeof *s->under);
    for (size_t i = 0; i < pairs; i++) {
        const struct place p = place_in(s, link, i);
        const float rest = s->product[i] / fmaxf(map_at(map, &p, taps), TINY);
        const float seen = rest * fmaxf(s->value[3 * i], 0.0f), made = rest * s->product[i];
        for (int k = 0; k < taps; k++) {
            s->above[p.cell[k]] += p.weight[k] * seen;
            s->under[p.cell[k]] += p.weight[k] * made;
        }
        s->product[i] = rest;
    }
    for (size_t k = 0; k < s->size[link]; k++)
        if (s->under[k] > TINY)
            map[3 * k] *= s->above[k] / s->under[k];
    for (size_t i = 0; i < pairs; i++) {
        const struct place p = place_in(s, link, i);
        s->product[i] *= fmaxf(map_at(map, &p, taps), TINY);
    }
}

// Means of 1 for all links but the first, which takes over their scale.
static void balance(struct chain *s)
{
    for (int link = LIGHT; link < LINKS; link++) {
        double sum = 0.0;
        for (size_t k = 0; k < s->size[link]; k++)
            sum += (double)s->map[link][3 * k];
        const float mean = (float)(sum / (double)s->size[link]);
        for (size_t k = 0; k < s->size[link] && mean > TINY; k++)
            s->map[link][3 * k] = fminf(s->map[link][3 * k] / mean, MOST_FACTOR);
        for (size_t k = 0; k < s->size[VIEW]; k++)
            s->map[VIEW][3 * k] *= mean;
    }
}

static void fit_chain(struct chain *s)
{
    const size_t pairs = s->size[VIEW] * s->size[LIGHT];
    for (size_t k = 0; k < entries(s->w->m); k++)
        s->factor[3 * k] = 1.0f;
    for (size_t i = 0; i < pairs; i++)
        s->product[i] = 1.0f;
    for (int round = 0; round < ROUNDS; round++)
        for (int link = 0; link < LINKS; link++)
            improve(s, (enum link)link);
    balance(s);
}

// ---------------------------------------------------------------- clusters

static bool fit_mean(const void *context, size_t cluster, const float *value)
{
    const struct cmf_fit *w = context;
    const relume_btf_fitted *m = w->m;
    const size_t pairs = model_pairs(m), n = entries(m);
    float *factor = mem_array(3 * n, sizeof *factor);
    float *product = mem_array(pairs, sizeof *product), *sums = mem_array(2 * n, sizeof *sums);
    const bool good = factor && product && sums;
    for (int c = 0; c < 3 && good; c++) {
        float *map = factor + c;
        struct chain s = {.w = w,
                          .value = value + c,
                          .factor = map,
                          .size = {(size_t)m->views, (size_t)m->lights, CELLS, CELLS},
                          .product = product,
                          .above = sums,
                          .under = sums + n};
        for (int link = 0; link < LINKS; map += 3 * s.size[link++])
            s.map[link] = map;
        fit_chain(&s);
    }
    for (size_t i = 0; i < 3 * n && good; i++)
        model_halfs(m, FACTOR)[cluster * 3 * n + i] = half_from_float(fminf(factor[i], 65504.0f));
    mem_free(factor);
    mem_free(product);
    mem_free(sums);
    return good;
}

static relume_status fit(struct fitting *f)
{
    const relume_btf_fitted *m = f->out;
    const size_t lights = (size_t)m->lights;
    struct cmf_fit w = {.m = f->out,
                        .half = mem_array(model_pairs(m), sizeof *w.half),
                        .difference = mem_array(model_pairs(m), sizeof *w.difference)};
    relume_status status = w.half && w.difference ? RELUME_OK : RELUME_ENOMEM;
    for (size_t i = 0; i < model_pairs(m) && !status; i++)
        places_of(m->view[i / lights], m->light[i % lights], &w.half[i], &w.difference[i]);
    if (!status)
        status = clusters_fit(f, CLUSTER, fit_mean, &w);
    mem_free(w.half);
    mem_free(w.difference);
    return status;
}

static void eval(const relume_btf_fitted *m, const struct model_at *at, float rgb[3])
{
    const size_t cluster = ((const uint16_t *)m->array[CLUSTER].data)[at->texel];
    const uint16_t *factor = model_halfs(m, FACTOR) + cluster * 3 * entries(m);
    const uint16_t *light = factor + 3 * (size_t)m->views, *maps = light + 3 * (size_t)m->lights;
    struct place place[2];
    places_of(at->v, at->l, &place[0], &place[1]);
    for (int c = 0; c < 3; c++) {
        rgb[c] =
            float_from_half(factor[3 * at->view + c]) * float_from_half(light[3 * at->light + c]);
        for (int i = 0; i < 2; i++) {
            float sum = 0.0f;
            for (int k = 0; k < 4; k++)
                sum += place[i].weight[k] *
                       float_from_half(maps[3 * (i * CELLS + place[i].cell[k]) + c]);
            rgb[c] *= sum;
        }
    }
}

// Three views and lights, two maps; the half vector and the frame it stands upright in.
static struct relume_btf_cost cost(const relume_btf_fitted *m)
{
    (void)m;
    return (struct relume_btf_cost){
        .ops = 3, .fetches = 1 + 2 + 3, .light_ops = 3 + 8 + 3, .light_fetches = 2 + 3 + 2};
}

const struct relume_btf_model model_cmf = {
    .name = "cmf",
    .summary = "products of factors of view, light and half vector for clusters of texels",
    .view_grid = true,
    .light_grid = true,
    .clusters = 512,
    .layout = layout,
    .fit = fit,
    .eval = eval,
    .cost = cost,
};
