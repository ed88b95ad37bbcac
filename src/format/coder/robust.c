// robust.c - fits that shadows, highlights and stray values do not pull
//
// Iteratively reweighted least squares: a light whose residual r at the pixel (over the channels)
// is large against the pixel's spread s weighs 1 / (1 + (r / s)^2) (Cauchy), with s = 2.385
// x 1.4826 x the median residual, the tuning that keeps 95 % efficiency where there are no outliers
// (Holland and Welsch 1977). A round solves the system of design.h with these weights.
#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "core/math/sort.h"
#include "format/coder/coding.h"
#include "format/coder/design.h"

#include <string.h>

enum { ROUNDS = 10 };
static const double LEAST_SPREAD = 0.5 / 255.0;

struct robust {
    struct design design;
};

void robust_destroy(struct robust *r)
{
    if (r)
        design_destroy(&r->design);
    mem_free(r);
}

relume_status robust_create(struct robust **out, const relume_coder *coder)
{
    struct robust *r = *out = mem_zeroed(1, sizeof *r);
    return r ? design_create(&r->design, coder) : RELUME_ENOMEM;
}

size_t robust_work(const struct robust *r)
{
    const size_t k = (size_t)r->design.k, n = (size_t)r->design.lights;
    return k * k + 3 * k + 3 * n + n + n;
}

// One pixel: `sets` vectors of samples over the rows become `sets` vectors of coefficients.
struct pixel {
    int sets;
    double *sample;       // [sets][rows]
    double *coefficient;  // [sets][k]
    double *system;       // [k][k]
    double *weight;       // [lights]
    double *sorted;       // [lights]
};

static double predict(const struct design *r, const double *c, int row)
{
    const double *y = r->y + (size_t)row * (size_t)r->k;
    double sum = 0.0;
    for (int j = 0; j < r->k; j++)
        sum += y[j] * c[j];
    return sum;
}

static void weigh(const struct design *r, const struct pixel *p)
{
    const int per_light = r->rows / r->lights;
    for (int i = 0; i < r->lights; i++) {
        double sum = 0.0;
        for (int s = 0; s < p->sets; s++)
            for (int row = i * per_light; row < (i + 1) * per_light; row++) {
                const double d =
                    p->sample[s * r->rows + row] - predict(r, p->coefficient + s * r->k, row);
                sum += d * d;
            }
        p->weight[i] = p->sorted[i] = sqrt(sum / (p->sets * per_light));
    }
    sort_doubles(p->sorted, (size_t)r->lights);
    const double spread = fmax(2.385 * 1.4826 * p->sorted[r->lights / 2], LEAST_SPREAD);
    for (int i = 0; i < r->lights; i++)
        p->weight[i] = 1.0 / (1.0 + p->weight[i] * p->weight[i] / (spread * spread));
}

static void solve(const struct design *r, const struct pixel *p)
{
    const int k = r->k, n = r->lights, per_light = r->rows / n;
    memcpy(p->system, r->prior, (size_t)(k * k) * sizeof *p->system);
    memset(p->coefficient, 0, (size_t)(p->sets * k) * sizeof *p->coefficient);
    for (int row = 0; row < r->rows; row++) {
        const double *y = r->y + (size_t)row * (size_t)k, w = p->weight[row / per_light] / n;
        for (int i = 0; i < k; i++) {
            const double wy = w * y[i];
            for (int j = 0; j <= i; j++)
                p->system[i * k + j] += wy * y[j];
            for (int s = 0; s < p->sets; s++)
                p->coefficient[s * k + i] += wy * p->sample[s * r->rows + row];
        }
    }
    for (int s = 0; r->fill && s < p->sets; s++)
        for (int i = 0; i < k; i++)
            for (int j = 0; j < n; j++)
                p->coefficient[s * k + i] += r->fill[i * n + j] * p->sample[s * n + j];
    lsq_solve(p->system, k, p->coefficient, p->sets);
}

void robust_apply(const struct robust *robust, const relume_coder *coder, const float *separated,
                  size_t n, float *planes, size_t plane_stride, double *work)
{
    const struct relume_coder_info *info = &coder->info;
    const struct design *r = &robust->design;
    const size_t lights = (size_t)r->lights;
    struct pixel p = {.sets = info->joint ? 1 : 3};
    p.system = work;
    p.coefficient = p.system + (size_t)r->k * (size_t)r->k;
    p.sample = p.coefficient + 3 * (size_t)r->k;
    p.weight = p.sample + 3 * lights;
    p.sorted = p.weight + lights;
    for (size_t x = 0; x < n; x++) {
        for (size_t c = 0; c < (info->luminance ? 1u : 3u); c++)
            for (size_t i = 0; i < lights; i++) {
                const size_t row = info->basis->joint ? i * 3 + c : c * lights + i;
                p.sample[row] = (double)separated[(c * lights + i) * n + x] -
                                (info->basis->joint ? r->constant[row] : 0.0);
            }
        for (int s = 0; s < p.sets; s++)
            for (int k = 0; k < r->k; k++)
                p.coefficient[s * r->k + k] =
                    (double)planes[(size_t)relume_coder_plane(info, k, s) * plane_stride + x];
        for (int round = 0; round < ROUNDS; round++) {
            weigh(r, &p);
            solve(r, &p);
        }
        for (int s = 0; s < p.sets; s++)
            for (int k = 0; k < r->k; k++)
                planes[(size_t)relume_coder_plane(info, k, s) * plane_stride + x] =
                    (float)p.coefficient[s * r->k + k];
    }
}
