// stereo.c - the normal of a pixel whose material is known
#include "capture/stereo/stereo.h"

#include "capture/stereo/evidence.h"
#include "capture/stereo/search.h"
#include "capture/stereo/sum.h"
#include "core/base/memory.h"

#include <string.h>

enum { REWEIGHED = 1 };
static const double first_step = 0.17, last_step = 0.006;  // 10 and 0.35 degrees
// Where its gloss is not seen a pixel has as much as the material: a fiftieth of the weight.
static const float held = 0.02f;
static const double apart = 0.07;         // 4 degrees
static const double hardly_known = 0.05;  // 3 degrees of error: half sure

// ---------------------------------------------------------------- one normal

struct job {
    struct stereo_pixel *pixel;
    const struct stereo_material *material;
    const struct stereo_table *table;
    struct stereo_scratch *scratch;
    float hold;  // how strongly gloss is held at matte
    float matte, gloss;
};

static void mix(float *matte, float *gloss, const struct stereo_material *m,
                const struct reflect_lights *lights, vec3 normal, struct stereo_scratch *scratch)
{
    const size_t stride = (size_t)lights->stride;
    reflect_parts(scratch->parts, m->which, lights, normal, scratch->cosines);
    memset(matte, 0, stride * sizeof *matte);
    memset(gloss, 0, stride * sizeof *gloss);
    for (size_t k = 0; k < REFLECT_PARTS; k++) {
        float *const to = k < REFLECT_MATTE ? matte : gloss;
        const float *const part = scratch->parts + k * stride, much = m->part[k];
        for (size_t i = 0; i < stride && (m->which >> k & 1); i++)
            to[i] += much * part[i];
    }
}

// The best matte and gloss of those that are not negative, and what they miss.
static double fit(struct job *j, const float *matte, const float *gloss)
{
    const struct stereo_pixel *p = j->pixel;
    float part[5][8] = {{0}}, sum[5];
    for (int i = 0; i < j->scratch->stride; i += 8)
        for (int k = 0; k < 8; k++) {
            const float a = matte[i + k], b = gloss[i + k], w = j->scratch->weight[i + k];
            const float y = p->value[i + k];
            part[0][k] += w * a * a;
            part[1][k] += w * a * b;
            part[2][k] += w * b * b;
            part[3][k] += w * a * y;
            part[4][k] += w * b * y;
        }
    for (int k = 0; k < 5; k++)
        sum[k] = ((part[k][0] + part[k][4]) + (part[k][2] + part[k][6])) +
                 ((part[k][1] + part[k][5]) + (part[k][3] + part[k][7]));
    const float aa = sum[0] + j->hold, ab = sum[1] - j->hold, bb = sum[2] + j->hold;
    const float determinant = aa * bb - ab * ab;
    j->matte = (sum[3] * bb - sum[4] * ab) / determinant;
    j->gloss = (sum[4] * aa - sum[3] * ab) / determinant;
    if (!(determinant > 1e-6f * aa * bb && j->matte > 0.0f && j->gloss > 0.0f)) {
        j->matte = aa > 0.0f ? fmaxf(sum[3] / aa, 0.0f) : 0.0f;
        j->gloss = bb > 0.0f ? fmaxf(sum[4] / bb, 0.0f) : 0.0f;
        if (j->matte * sum[3] > j->gloss * sum[4])
            j->gloss = 0.0f;
        else
            j->matte = 0.0f;
    }
    return (double)(j->matte * (j->matte * aa - 2.0f * sum[3]) +
                    j->gloss * (j->gloss * bb - 2.0f * sum[4]) + 2.0f * j->matte * j->gloss * ab);
}

static void hold_gloss(struct job *j, const float *gloss)
{
    float energy = 0.0f;
    for (int i = 0; i < j->scratch->stride; i++)
        energy += j->scratch->weight[i] * gloss[i] * gloss[i];
    j->hold = held * energy;
}

static void expect(struct job *j, const float *matte, const float *gloss)
{
    for (int i = 0; i < j->scratch->stride; i++)
        j->scratch->expected[i] = j->matte * matte[i] + j->gloss * gloss[i];
}

static double cost_at(void *context, vec3 normal)
{
    struct job *j = context;
    mix(j->scratch->matte, j->scratch->gloss, j->material, j->pixel->lights, normal, j->scratch);
    return fit(j, j->scratch->matte, j->scratch->gloss);
}

static void accept(void *context)
{
    struct job *j = context;
    j->pixel->matte = j->matte;
    j->pixel->gloss = j->gloss;
}

static double settle(void *context, vec3 normal)
{
    struct job *j = context;
    mix(j->scratch->matte, j->scratch->gloss, j->material, j->pixel->lights, normal, j->scratch);
    hold_gloss(j, j->scratch->gloss);
    for (int i = 0; i < REWEIGHED; i++) {
        fit(j, j->scratch->matte, j->scratch->gloss);
        expect(j, j->scratch->matte, j->scratch->gloss);
        evidence_weigh(j->pixel, j->scratch);
    }
    const double cost = fit(j, j->scratch->matte, j->scratch->gloss);
    accept(j);
    return cost;
}

// ---------------------------------------------------------------- where to begin

void stereo_table_destroy(struct stereo_table *table)
{
    mem_free(table->matte);
    mem_free(table->gloss);
    *table = (struct stereo_table){0};
}

relume_status stereo_table_create(struct stereo_table *out, const struct stereo_material *material,
                                  const struct reflect_lights *lights,
                                  struct stereo_scratch *scratch)
{
    const size_t stride = (size_t)lights->stride;
    *out = (struct stereo_table){mem_array(SEARCH_STARTS * stride, sizeof(float)),
                                 mem_array(SEARCH_STARTS * stride, sizeof(float))};
    if (!out->matte || !out->gloss) {
        stereo_table_destroy(out);
        return RELUME_ENOMEM;
    }
    for (size_t i = 0; i < SEARCH_STARTS; i++)
        mix(out->matte + i * stride, out->gloss + i * stride, material, lights,
            search_start((int)i, lights->eye), scratch);
    return RELUME_OK;
}

static float miss_of(struct job *j, const float *matte, const float *gloss)
{
    memcpy(j->scratch->weight, j->scratch->base, (size_t)j->scratch->stride * sizeof(float));
    hold_gloss(j, gloss);
    fit(j, matte, gloss);
    expect(j, matte, gloss);
    return evidence_miss(j->pixel, j->scratch);
}

// The first guess, or one of the normals all around that misses less.
static vec3 find_start(struct job *j)
{
    struct stereo_scratch *const scratch = j->scratch;
    const size_t stride = (size_t)scratch->stride;
    const struct reflect_lights *const lights = j->pixel->lights;
    vec3 best = j->pixel->normal;
    mix(scratch->matte, scratch->gloss, j->material, lights, best, scratch);
    float least = miss_of(j, scratch->matte, scratch->gloss);
    for (size_t i = 0; i < SEARCH_STARTS; i++) {
        const vec3 n = search_start((int)i, lights->eye);
        const float *matte = scratch->matte, *gloss = scratch->gloss;
        if (j->table) {
            matte = j->table->matte + i * stride;
            gloss = j->table->gloss + i * stride;
        } else
            mix(scratch->matte, scratch->gloss, j->material, lights, n, scratch);
        const float miss = miss_of(j, matte, gloss);
        if (miss < least) {
            least = miss;
            best = n;
        }
    }
    return best;
}

// By the standard error of the normal, in the direction in which it is known least.
static float sureness(struct job *j, double least)
{
    double beside = INFINITY, energy = 0.0, count = 0.0;
    for (int i = 0; i < SEARCH_SIDES; i++)
        beside = fmin(beside, cost_at(j, search_beside(j->pixel->normal, apart, i, 0.0)));
    for (int i = 0; i < j->scratch->stride; i++) {
        const double w = (double)j->scratch->weight[i], v = (double)j->pixel->value[i];
        energy += w * v * v;
        count += j->scratch->base[i] > 0.0f ? w / (double)j->scratch->base[i] : 0.0;
    }
    const double variance = fmax(energy + least, 1e-6 * energy) / fmax(count - 4.0, 1.0);
    const double error = apart * sqrt(variance / fmax(beside - least, 1e-12 * energy));
    return (float)(1.0 / (1.0 + error * error / (hardly_known * hardly_known)));
}

bool stereo_solve(struct stereo_pixel *p, const struct stereo_material *material,
                  const struct stereo_table *table, struct stereo_scratch *scratch)
{
    struct job j = {.pixel = p, .material = material, .table = table, .scratch = scratch};
    if (!evidence_begin(p, scratch))
        return false;
    const vec3 start = find_start(&j);
    memcpy(scratch->weight, scratch->base, (size_t)scratch->stride * sizeof(float));
    p->normal = search_find(
        &(struct search){&j, settle, cost_at, accept, first_step, last_step, p->lights->eye},
        start);
    const double least = settle(&j, p->normal);
    p->miss = evidence_miss(p, scratch);
    if (p->weight)
        memcpy(p->weight, scratch->weight, (size_t)scratch->stride * sizeof(float));
    p->sure = sureness(&j, least) * (1.0f - p->miss);
    return true;
}
