// design.c - a coder's fit as a system for one pixel, whose rows may be weighed or stand elsewhere
#include "format/coder/design.h"

#include "core/base/memory.h"
#include "core/math/lsq.h"

static const double JOINT_PRIOR = 1e-3;  // of the mean of the diagonal: components without data

void design_destroy(struct design *d)
{
    mem_free(d->y);
    mem_free(d->constant);
    mem_free(d->prior);
    mem_free(d->fill);
    *d = (struct design){0};
}

void design_rows(double *y, double *constant, const struct design *d, const relume_coder *coder,
                 const struct relume_vec3 *direction, float *weights)
{
    const int k = d->k, channels = d->rows / d->lights;
    float one[3];
    for (int i = 0; i < d->lights; i++) {
        relume_coder_weights(coder, direction[i], weights, one);
        for (int c = 0; c < channels; c++) {
            constant[i * channels + c] = (double)one[c];
            for (int j = 0; j < k; j++)
                y[(size_t)(i * channels + c) * (size_t)k + (size_t)j] = (double)weights[c * k + j];
        }
    }
}

static void fill_prior(struct design *d, const relume_coder *coder)
{
    const size_t k = (size_t)d->k, n = (size_t)d->lights;
    lsq_add_gram(d->prior, d->k, d->y, d->rows);
    double trace = 0.0;
    for (size_t i = 0; i < k; i++)
        trace += d->prior[i * k + i];
    for (size_t i = 0; i < k * k; i++) {
        const double unit = i / k == i % k;
        d->prior[i] =
            d->fill ? unit - d->prior[i] / (double)n : unit * JOINT_PRIOR * trace / (double)(k * n);
    }
    for (size_t i = 0; d->fill && i < k * n; i++)
        d->fill[i] = (double)coder->map[i] - d->y[i % n * k + i / n] / (double)n;
}

relume_status design_create(struct design *out, const relume_coder *coder)
{
    const size_t k = (size_t)coder->info.coefficients, n = (size_t)coder->info.lights;
    const bool learned = coder->info.basis->learned;
    const size_t rows = coder->info.basis->joint ? 3 * n : n;
    float *weights = mem_array(3 * k, sizeof *weights);
    *out = (struct design){
        .lights = (int)n,
        .k = (int)k,
        .rows = (int)rows,
        .y = mem_array(rows * k, sizeof *out->y),
        .constant = mem_array(rows, sizeof *out->constant),
        .prior = mem_zeroed(k * k, sizeof *out->prior),
        .fill = learned ? NULL : mem_array(k * n, sizeof *out->fill),
    };
    const bool whole = weights && out->y && out->constant && out->prior && (out->fill || learned);
    if (whole) {
        design_rows(out->y, out->constant, out, coder, coder->world, weights);
        fill_prior(out, coder);
    } else {
        design_destroy(out);
    }
    mem_free(weights);
    return whole ? RELUME_OK : RELUME_ENOMEM;
}
