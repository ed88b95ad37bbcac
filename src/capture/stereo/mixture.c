// mixture.c - non-negative least squares by coordinate descent
#include "capture/stereo/mixture.h"

#include "capture/stereo/sum.h"

static const double ridge = 1e-4;    // of a part's own energy: neighbouring lobes are much alike
static const double settled = 1e-5;  // of the energy: what a sweep must still gain

void mixture_add(struct mixture *to, const float *parts, size_t stride, float scale,
                 const float *value, const float *weight, float *scratch)
{
    for (size_t k = 0; k < REFLECT_PARTS; k++) {
        if (!(to->which >> k & 1))
            continue;
        for (size_t i = 0; i < stride; i++)
            scratch[i] = scale * weight[i] * parts[k * stride + i];
        for (size_t j = 0; j <= k; j++)
            if (to->which >> j & 1)
                to->gram[k][j] +=
                    (double)(scale * sum_products(scratch, parts + j * stride, stride));
        for (size_t j = 0; j < k; j++)
            to->gram[j][k] = to->gram[k][j];
        to->b[k] += (double)sum_products(scratch, value, stride);
    }
    for (size_t i = 0; i < stride; i++)
        scratch[i] = weight[i] * value[i];
    to->energy += (double)sum_products(scratch, value, stride);
}

static double pull_of(const struct mixture *s, const float *part, int k)
{
    double pull = s->b[k];
    for (int j = 0; j < REFLECT_PARTS; j++)
        pull -= s->gram[k][j] * (double)part[j];
    return pull;
}

static double sweep(const struct mixture *s, float *part)
{
    double gained = 0.0;
    for (int k = 0; k < REFLECT_PARTS; k++) {
        const double own = s->gram[k][k];
        if (!(own > 1e-12)) {
            part[k] = 0.0f;
            continue;
        }
        const double moved = fmax(pull_of(s, part, k) / (own * (1.0 + ridge)), -(double)part[k]);
        gained += moved * moved * own;
        part[k] = fmaxf((float)((double)part[k] + moved), 0.0f);
    }
    return gained;
}

double mixture_solve(const struct mixture *s, float part[REFLECT_PARTS], int sweeps)
{
    for (int i = 0; i < sweeps && sweep(s, part) > settled * s->energy; i++)
        ;
    double cost = s->energy;
    for (int k = 0; k < REFLECT_PARTS; k++)
        cost -= (double)part[k] * (s->b[k] + pull_of(s, part, k));
    return cost;
}
