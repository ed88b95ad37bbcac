// choose.c - leave one light out: which kernel predicts the captured lights best from each other
//
// All of it happens on the N x N Gram matrix G of the images: with B of a kernel (interpolant.h)
// the mean squared error of light i, predicted from the others, is e_i = (B G B)_ii / B_ii^2. The
// mean of ln e_i is minimised, so that every light counts by its ratio, as in decibels. No light is
// used to predict itself, and no other data is seen.
#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "format/coder/basis.h"
#include "format/coder/interpolant.h"
#include "format/coder/sums.h"

#include <string.h>

// Squared errors below a third of an 8-bit step do not count.
static const double FLOOR = 0.1 / (255.0 * 255.0);

void predict_errors(double *error, const double *b, const double *gram, int lights)
{
    const size_t n = (size_t)lights;
    for (size_t i = 0; i < n; i++) {
        const double *row = b + i * n;
        double sum = 0.0;
        for (size_t j = 0; j < n; j++) {
            double inner = 0.0;
            for (size_t k = 0; k < n; k++)
                inner += gram[j * n + k] * row[k];
            sum += row[j] * inner;
        }
        error[i] = fmax(sum, 0.0) / (row[i] * row[i]) + FLOOR;
    }
}

struct search {
    const struct relume_vec3 *lights;
    int n;
    const double *gram;
    double *b, *error;
};

static relume_status score(struct search *s, const double *parameter, double *mean)
{
    void *data;
    const relume_status status = interpolant_chord.prepare(&data, s->lights, s->n, parameter, NULL);
    *mean = HUGE_VAL;
    if (status)
        return status == RELUME_ENOMEM ? status : RELUME_OK;
    interpolant_chord.predictor(data, s->b);
    interpolant_chord.release(data);
    predict_errors(s->error, s->b, s->gram, s->n);
    *mean = 0.0;
    for (int i = 0; i < s->n; i++)
        *mean += log(s->error[i]) / s->n;
    return RELUME_OK;
}

// Power, stretch, nugget, strength of the second degree. The search stays near what is good for
// most: one light left out makes a hole twice as wide as any in use, which favours smoothness.
static const double steps[4][3] = {{1.5, 1.2, 1.8}, {1.5, 1.0, 0.7}, {0.0, 0.01, 0.03}, {0.0, 4.0}};
static const int counts[4] = {3, 3, 3, 2};

// Every combination.
static relume_status search_all(struct search *s, double *best, double *least)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < 54; i++) {
        const double p[4] = {steps[0][i / 6 % 3], steps[1][i / 18], steps[2][i / 2 % 3],
                             steps[3][i % 2]};
        double mean;
        status = score(s, p, &mean);
        if (!status && mean < *least) {
            *least = mean;
            memcpy(best, p, sizeof p);
        }
    }
    return status;
}

// One parameter after the other, for sets of lights whose systems take long.
static relume_status search_axes(struct search *s, double *best, double *least)
{
    relume_status status = score(s, best, least);
    for (int axis = 0; axis < 4; axis++)
        for (int i = 1; !status && i < counts[axis]; i++) {
            double p[4], mean;
            memcpy(p, best, sizeof p);
            p[axis] = steps[axis][i];
            status = score(s, p, &mean);
            if (!status && mean < *least) {
                *least = mean;
                memcpy(best, p, sizeof p);
            }
        }
    return status;
}

relume_status interpolant_choose(double *parameter, double *rms, const struct relume_vec3 *lights,
                                 const struct relume_samples *samples, int threads)
{
    enum { FEW = 160 };
    const int n = samples->lights;
    const size_t size = (size_t)n;
    double *gram = mem_array(size * size, sizeof *gram);
    double best[4] = {steps[0][0], steps[1][0], 0.0, 0.0}, least = HUGE_VAL;
    struct search s = {lights, n, gram, mem_array(size * size, sizeof(double)),
                       mem_array(size, sizeof(double))};
    relume_status status = gram && s.b && s.error ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = samples_gram(gram, samples, threads);
    if (!status)
        status = (n <= FEW ? search_all : search_axes)(&s, best, &least);
    if (!status) {
        memcpy(parameter, best, sizeof best);
        *rms = exp(0.5 * least);
    }
    mem_free(gram);
    mem_free(s.b);
    mem_free(s.error);
    return status;
}
