// free.c - the normal for which some sum of parts fits best
#include "capture/stereo/free.h"

#include "capture/stereo/mixture.h"
#include "capture/stereo/evidence.h"
#include "capture/stereo/search.h"
#include "capture/stereo/sum.h"

#include <string.h>

enum { SWEEPS = 30, REWEIGHED = 3, ALL = (1 << REFLECT_PARTS) - 1 };
static const double first_step = 0.14, last_step = 0.0035;  // 8 and 0.2 degrees
static const double apart = 0.07;  // 4 degrees: where a sure normal costs much more

struct job {
    struct stereo_pixel *pixel;
    struct stereo_scratch *scratch;
    struct mixture mixture;
    float trial[REFLECT_PARTS];
};

static double fit(struct job *j, float part[REFLECT_PARTS])
{
    const struct stereo_pixel *p = j->pixel;
    j->mixture = (struct mixture){.which = ALL};
    mixture_add(&j->mixture, j->scratch->parts, (size_t)j->scratch->stride, 1.0f, p->value,
                j->scratch->weight, j->scratch->spare);
    return mixture_solve(&j->mixture, part, SWEEPS);
}

static double cost_at(void *context, vec3 normal)
{
    struct job *j = context;
    reflect_parts(j->scratch->parts, ALL, j->pixel->lights, normal, j->scratch->cosines);
    memcpy(j->trial, j->pixel->part, sizeof j->trial);
    return fit(j, j->trial);
}

static void accept(void *context)
{
    struct job *j = context;
    memcpy(j->pixel->part, j->trial, sizeof j->trial);
}

static void expect(struct job *j)
{
    const size_t stride = (size_t)j->scratch->stride;
    memset(j->scratch->expected, 0, stride * sizeof(float));
    for (size_t k = 0; k < REFLECT_PARTS; k++)
        for (size_t i = 0; i < stride && j->pixel->part[k] > 0.0f; i++)
            j->scratch->expected[i] += j->pixel->part[k] * j->scratch->parts[k * stride + i];
}

static double settle(void *context, vec3 normal)
{
    struct job *j = context;
    double cost = cost_at(j, normal);
    accept(j);
    for (int i = 0; i < REWEIGHED; i++) {
        expect(j);
        evidence_weigh(j->pixel, j->scratch);
        cost = fit(j, j->pixel->part);
    }
    return cost;
}

static float sureness(struct job *j, double least)
{
    double beside = INFINITY, kept = 0.0, known = 0.0;
    for (int i = 0; i < SEARCH_SIDES; i++)
        beside = fmin(beside, cost_at(j, search_beside(j->pixel->normal, apart, i, 0.0)));
    for (int i = 0; i < j->scratch->stride; i++) {
        known += j->pixel->value[i] >= 0.0f;
        kept += j->pixel->value[i] >= 0.0f && j->scratch->weight[i] > 0.5f * j->scratch->base[i];
    }
    return (float)((beside - least) / (least + 1e-4 * j->mixture.energy) * kept / known);
}

static void begin(struct job *j)
{
    memcpy(j->scratch->weight, j->scratch->base, (size_t)j->scratch->stride * sizeof(float));
    for (int k = 0; k < REFLECT_PARTS; k++)
        j->pixel->part[k] = 0.1f * j->pixel->middle;
}

static vec3 find_start(struct job *j)
{
    vec3 best = j->pixel->guess;
    begin(j);
    double least = cost_at(j, best);
    for (int i = 0; i < SEARCH_STARTS; i++) {
        const vec3 n = search_start(i, j->pixel->lights->eye);
        const double cost = cost_at(j, n);
        if (cost < least) {
            least = cost;
            best = n;
        }
    }
    return best;
}

bool free_solve(struct stereo_pixel *p, bool around, struct stereo_scratch *scratch)
{
    struct job j = {.pixel = p, .scratch = scratch};
    if (!evidence_begin(p, scratch))
        return false;
    const vec3 start = around ? find_start(&j) : p->guess;
    begin(&j);
    p->normal = search_find(
        &(struct search){&j, settle, cost_at, accept, first_step, last_step, p->lights->eye},
        start);
    const double least = settle(&j, p->normal);
    memcpy(p->weight, scratch->weight, (size_t)scratch->stride * sizeof(float));
    p->sure = sureness(&j, least);
    return true;
}
