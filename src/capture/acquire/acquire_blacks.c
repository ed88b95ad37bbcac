// acquire_blacks.c - light that belongs to no lamp: haze, a lit room, a black level not taken off
//
// Where even the darkest percent of all photographs is grey, no shadow is deep. A matte pixel's
// value is then affine in the light's direction, and its intercept is what it shows without a
// light. Only the lower half of the lights counts, whose gloss does not reach the camera. A pale
// board under high lamps is as bright throughout, but has no intercept. Where the lights do not
// tell, blacks that end at one value do.
#include "capture/acquire/acquire.h"

#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "core/math/sort.h"

enum { LEAST_SHOTS = 6, UNKNOWNS = 4, PIXELS = 2000 };
static const double GREY = 0.03;       // of white: the darkest percent
static const double DARKEST = 0.01;    // share of the samples
static const double INTERCEPT = 0.03;  // of white: 0.028 at most on 30 sound captures
static const double FLOOR = 0.97;      // of the darkest 5 %: the darkest half percent; 0.94 at most
static const double CLIPPED = 0.98;
static const double MOST_NOISE = 4.0;  // variance of an intercept over that of a sample

static vec3 direction_of(const struct acquisition *s, int i)
{
    return vec3_unit(s->p.near ? s->shot[i].position : s->shot[i].direction);
}

static void unknowns(double out[UNKNOWNS], vec3 d)
{
    out[0] = 1.0;
    out[1] = d.x;
    out[2] = d.y;
    out[3] = d.z;
}

static double quantile(double *v, size_t n, double share)
{
    sort_doubles(v, n);
    return n ? v[(size_t)(share * (double)(n - 1))] : 0.0;
}

// weight[shots] of the values whose sum is the intercept; false where the lights do not tell.
static bool weigh_intercept(const struct acquisition *s, double *weight)
{
    double m[UNKNOWNS * UNKNOWNS] = {0.0}, first[UNKNOWNS] = {1.0}, u[UNKNOWNS], squares = 0.0;
    for (int i = 0; i < s->shots; i++)
        weight[i] = direction_of(s, i).z;
    const double highest = fmax(quantile(weight, (size_t)s->shots, 0.5), weight[LEAST_SHOTS - 1]);
    for (int i = 0; i < s->shots; i++) {
        unknowns(u, direction_of(s, i));
        const bool counts = u[3] <= highest && !s->shot[i].misfit;
        for (int k = 0; counts && k < UNKNOWNS * UNKNOWNS; k++)
            m[k] += u[k / UNKNOWNS] * u[k % UNKNOWNS];
    }
    for (int k = 0; k < UNKNOWNS; k++)
        m[k * (UNKNOWNS + 1)] += 1e-6;
    if (!lsq_solve(m, UNKNOWNS, first, 1))
        return false;
    for (int i = 0; i < s->shots; i++) {
        unknowns(u, direction_of(s, i));
        weight[i] = 0.0;
        const bool counts = u[3] <= highest && !s->shot[i].misfit;
        for (int k = 0; counts && k < UNKNOWNS; k++)
            weight[i] += first[k] * u[k];
        squares += weight[i] * weight[i];
    }
    return squares < MOST_NOISE;
}

struct blacks {
    size_t pixels, step;
    double *weight, *value, *intercept;  // [shots], [shots][pixels], [pixels]
};

static double sample(const struct blacks *b, const struct shot *shot, size_t k)
{
    const float *p = shot->small.data + 3 * k * b->step;
    return (double)(p[0] + p[1] + p[2]) / 3.0;
}

// The median intercept of the pixels that do not clip.
static double find_intercept(const struct blacks *b, const struct acquisition *s)
{
    size_t n = 0;
    for (size_t k = 0; k < b->pixels; k++) {
        double sum = 0.0, most = 0.0;
        for (int i = 0; i < s->shots; i++) {
            const double v = sample(b, &s->shot[i], k);
            sum += b->weight[i] * v;
            most = fmax(most, b->weight[i] != 0.0 ? v : 0.0);
        }
        if (most < CLIPPED)
            b->intercept[n++] = sum;
    }
    return quantile(b->intercept, n, 0.5);
}

static relume_status judge(struct acquisition *s, const struct blacks *b)
{
    const size_t n = (size_t)s->shots * b->pixels;
    for (size_t i = 0; i < n; i++)
        b->value[i] = sample(b, &s->shot[i / b->pixels], i % b->pixels);
    const double darkest = quantile(b->value, n, DARKEST);
    if (darkest < GREY)
        return RELUME_OK;
    const double end = quantile(b->value, n, 0.5 * DARKEST) / quantile(b->value, n, 5.0 * DARKEST);
    const bool lifted = weigh_intercept(s, b->weight) ? find_intercept(b, s) > INTERCEPT : false;
    if (!lifted && end < FLOOR)
        return RELUME_OK;
    return acquire_warn(
        s,
        "blacks are lifted: the darkest hundredth of all photographs has %.0f %% of "
        "white; a lit room, haze, a dirty lens, or a RAW whose black level is not "
        "known?",
        100.0 * darkest);
}

relume_status acquire_check_blacks(struct acquisition *s)
{
    const struct relume_image *first = &s->shot[0].small;
    const size_t all = (size_t)first->width * (size_t)first->height, shots = (size_t)s->shots;
    struct blacks b = {.step = all / PIXELS + 1};
    if (s->shots < LEAST_SHOTS || s->shot[0].notes.floats)
        return RELUME_OK;
    b.pixels = (all + b.step - 1) / b.step;
    b.weight = mem_array(shots, sizeof *b.weight);
    b.value = mem_array(shots * b.pixels, sizeof *b.value);
    b.intercept = mem_array(b.pixels, sizeof *b.intercept);
    const relume_status status = b.weight && b.value && b.intercept ? judge(s, &b) : RELUME_ENOMEM;
    mem_free(b.weight);
    mem_free(b.value);
    mem_free(b.intercept);
    return status;
}
