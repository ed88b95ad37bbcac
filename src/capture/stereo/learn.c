// learn.c - what an object is made of
//
// Several kinds are tried, the simplest first: Lambert's law alone, with gloss, with roughness,
// with all parts; from the normals that were guessed or from those that a free reflectance leads
// to. Each is fitted to the surest pixels, then to all of them with the normals that it leads to,
// in turn. The one that misses least is right: wrong ones cannot fit all pixels at once. Where
// Lambert's law alone does about as well, the robust normals it began with are better than any.
#include "capture/stereo/stereo.h"

#include "core/base/thread.h"
#include "capture/stereo/mixture.h"
#include "capture/stereo/free.h"
#include "capture/stereo/sum.h"

#include <stdlib.h>
#include <string.h>

enum {
    GLOSS = ((1 << REFLECT_LOBES) - 1) << REFLECT_MATTE,
    TEACHING = 2,
    TURNS = 4,
    REFINED = 3,
    SWEEPS = 500,
};
static const struct kind {
    unsigned which;
    enum { GUESSED, FREE, AROUND } begin;  // with the first guess, or with what free_solve() finds
} kinds[] = {
    {1u << 0, GUESSED},      {1u << 0 | GLOSS, GUESSED},
    {1u << 0 | GLOSS, FREE}, {1u << 0 | 1u << 3 | GLOSS, FREE},
    {0xfu | GLOSS, FREE},    {1u << 0 | GLOSS, AROUND},
    {0xfu | GLOSS, AROUND},
};
static const double surest = 0.3;    // of the pixels teach first
static const double simpler = 1.15;  // matte alone is better unless it misses so much more
static const float nothing = 1e-4f;  // of a material's largest part

struct lesson {
    struct stereo_pixel *pixel;
    int n;
    bool around;
    const struct stereo_material *material;
    struct stereo_scratch *scratch;
    int threads;
};

static int by_sureness(const void *a, const void *b)
{
    const struct stereo_pixel *p = a, *q = b;
    if (p->sure != q->sure)
        return p->sure > q->sure ? -1 : 1;
    return p->value < q->value ? -1 : p->value > q->value;
}

static void solve_freely(void *context, size_t item, int worker)
{
    const struct lesson *l = context;
    if (!free_solve(l->pixel + item, l->around, l->scratch + worker))
        l->pixel[item].sure = -1.0f;
    l->pixel[item].free = l->pixel[item].normal;
}

static void solve(void *context, size_t item, int worker)
{
    const struct lesson *l = context;
    stereo_solve(l->pixel + item, l->material, NULL, l->scratch + worker);
}

static void find_brightness(void *context, size_t item, int worker)
{
    const struct lesson *l = context;
    struct stereo_pixel *p = l->pixel + item;
    struct stereo_scratch *scratch = l->scratch + worker;
    const size_t stride = (size_t)scratch->stride;
    reflect_parts(scratch->parts, l->material->which, p->lights, p->normal, scratch->cosines);
    memset(scratch->expected, 0, stride * sizeof(float));
    for (size_t k = 0; k < REFLECT_PARTS; k++)
        for (size_t i = 0; i < stride && (l->material->which >> k & 1); i++)
            scratch->expected[i] += l->material->part[k] * scratch->parts[k * stride + i];
    for (size_t i = 0; i < stride; i++)
        scratch->spare[i] = p->weight[i] * scratch->expected[i];
    const float energy = sum_products(scratch->spare, scratch->expected, stride);
    p->matte = energy > 0.0f ? sum_products(scratch->spare, p->value, stride) / energy : 0.0f;
}

static void find_material(struct stereo_material *out, unsigned which, const struct lesson *l,
                          int pixels)
{
    struct mixture mixture = {.which = which};
    const struct stereo_scratch *scratch = l->scratch;
    for (int i = 0; i < pixels; i++) {
        const struct stereo_pixel *p = l->pixel + i;
        reflect_parts(scratch->parts, which, p->lights, p->normal, scratch->cosines);
        const float unit = 1.0f / p->middle;
        for (int k = 0; k < scratch->stride; k++)
            scratch->expected[k] = unit * unit * p->weight[k];
        mixture_add(&mixture, scratch->parts, (size_t)scratch->stride, p->matte, p->value,
                    scratch->expected, scratch->spare);
    }
    mixture_solve(&mixture, out->part, SWEEPS);
    float most = 0.0f;
    for (int k = 0; k < REFLECT_PARTS; k++)
        most = fmaxf(most, out->part[k]);
    out->which = 0;
    for (int k = 0; k < REFLECT_PARTS; k++)
        if (out->part[k] > nothing * most)
            out->which |= 1u << k;
        else
            out->part[k] = 0.0f;
}

static double mean_miss(const struct lesson *l)
{
    double miss = 0.0;
    for (int i = 0; i < l->n; i++)
        miss += (double)l->pixel[i].miss / l->n;
    return miss;
}

static void teach(struct stereo_material *out, unsigned which, struct lesson *l)
{
    const int sure = (int)(surest * l->n) + 1 < l->n ? (int)(surest * l->n) + 1 : l->n;
    l->material = out;
    for (int k = 0; k < REFLECT_PARTS; k++)
        out->part[k] = which >> k & 1 ? 0.1f : 0.0f;
    for (int i = 0; i < l->n; i++)
        l->pixel[i].matte = l->pixel[i].middle;
    for (int turn = 0; turn < TURNS; turn++) {
        find_material(out, which, l, turn <= TEACHING ? sure : l->n);
        if (turn >= TEACHING)
            thread_for(l->threads, (size_t)l->n, solve, l);
        thread_for(l->threads, (size_t)l->n, find_brightness, l);
    }
}

// By all pixels, with normals and material in turn.
static void refine(struct stereo_material *out, unsigned which, struct lesson *l)
{
    l->material = out;
    for (int turn = 0; turn < REFINED; turn++) {
        thread_for(l->threads, (size_t)l->n, solve, l);
        thread_for(l->threads, (size_t)l->n, find_brightness, l);
        find_material(out, which, l, l->n);
    }
}

// Those too dark go to the end.
static void find_free(struct lesson *l, bool around)
{
    l->around = around;
    thread_for(l->threads, (size_t)l->n, solve_freely, l);
    qsort(l->pixel, (size_t)l->n, sizeof *l->pixel, by_sureness);
    while (l->n && l->pixel[l->n - 1].sure < 0.0f)
        l->n--;
}

static void choose(struct stereo_material *out, const struct kind **best, struct lesson *l)
{
    double least = INFINITY;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        struct stereo_material material = {0};
        if (k > 0 && kinds[k].begin == AROUND && kinds[k - 1].begin != AROUND)
            find_free(l, true);
        for (int i = 0; i < l->n; i++)
            l->pixel[i].normal = kinds[k].begin == GUESSED ? l->pixel[i].guess : l->pixel[i].free;
        teach(&material, kinds[k].which, l);
        const double miss = mean_miss(l) * (k > 0 ? simpler : 1.0);
        if (k > 0 && !(miss < least))
            continue;
        least = miss;
        *out = material;
        *best = kinds + k;
        for (int i = 0; i < l->n; i++)
            l->pixel[i].kept = l->pixel[i].normal;
    }
    for (int i = 0; i < l->n; i++)
        l->pixel[i].normal = l->pixel[i].kept;
}

bool stereo_learn(struct stereo_material *out, struct stereo_pixel *pixel, int n,
                  struct stereo_scratch *scratch, int threads)
{
    struct lesson l = {.pixel = pixel, .n = n, .scratch = scratch, .threads = threads};
    const struct kind *kind = kinds;
    for (int i = 0; i < n; i++)
        pixel[i].guess = pixel[i].normal;
    find_free(&l, false);
    if (!l.n)
        return false;
    choose(out, &kind, &l);
    if (kind == kinds)
        return false;
    refine(out, kind->which, &l);
    return true;
}
