// basis_pca.c - principal components of the reflectance table, joint over R, G, B
//
// A pixel's 3 N samples t (N lights, three channels) are written as t = mean + sum_k c_k v_k with
// the K orthonormal directions v_k of largest variance over the pixels. Between the lights mean and
// v_k are interpolated: b_k,c(L) = sum_i a_i(L) v_k[c, i], a being the weights of the interpolant.
// The interpolant matters more than the number of components.
#include "base/log.h"
#include "base/memory.h"
#include "coder/basis.h"
#include "math/lsq.h"

enum { DEFAULT_COUNT = 27, BATCH = 512 };

static bool has_count(int count)
{
    return count >= 1 && count <= CODER_MAX_COEFFICIENTS;
}

static int fit_count(int want, int lights)
{
    const int most = want ? want : DEFAULT_COUNT;
    return most > 3 * lights ? 3 * lights : most;
}

// One pixel's samples as [channel][light].
static void gather(double *row, const struct relume_samples *s, size_t pixel)
{
    for (size_t i = 0; i < (size_t)s->lights; i++)
        for (size_t c = 0; c < 3; c++)
            row[c * (size_t)s->lights + i] = (double)s->data[(i * s->pixels + pixel) * 3 + c];
}

static relume_status find_mean(const struct relume_samples *s, size_t dim, double *mean)
{
    double *row = mem_array(dim, sizeof *row);
    if (!row)
        return RELUME_ENOMEM;
    for (size_t x = 0; x < s->pixels; x++) {
        gather(row, s, x);
        for (size_t j = 0; j < dim; j++)
            mean[j] += row[j] / (double)s->pixels;
    }
    free(row);
    return RELUME_OK;
}

static relume_status find_covariance(const struct relume_samples *s, int dim, const double *mean,
                                     double *gram)
{
    const size_t d = (size_t)dim;
    double *rows = mem_array(BATCH * d, sizeof *rows);
    if (!rows)
        return RELUME_ENOMEM;
    for (size_t x = 0; x < s->pixels; x += BATCH) {
        const size_t n = s->pixels - x < BATCH ? s->pixels - x : BATCH;
        for (size_t i = 0; i < n; i++) {
            gather(rows + i * d, s, x + i);
            for (size_t j = 0; j < d; j++)
                rows[i * d + j] -= mean[j];
        }
        lsq_add_gram(gram, dim, rows, (int)n);
    }
    free(rows);
    return RELUME_OK;
}

// Components and mean become the stored functions, the components the encoding map.
static relume_status keep(relume_coder *coder, const double *mean, const double *vectors)
{
    const size_t k = (size_t)coder->info.coefficients, n = (size_t)coder->info.lights;
    coder->map = mem_array(3 * k * n, sizeof *coder->map);
    coder->base = mem_zeroed(k, sizeof *coder->base);
    coder->transform = mem_array(3 * k * n, sizeof *coder->transform);
    coder->mean = mem_array(3 * n, sizeof *coder->mean);
    if (!coder->map || !coder->base || !coder->transform || !coder->mean)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < k; i++) {
        double base = 0.0;
        for (size_t c = 0; c < 3; c++)
            for (size_t j = 0; j < n; j++) {
                const double v = vectors[(i * 3 + c) * n + j];
                coder->map[(i * 3 + c) * n + j] = (float)v;
                coder->transform[(c * k + i) * n + j] = (float)v;
                base -= v * mean[c * n + j];
            }
        coder->base[i] = (float)base;
    }
    for (size_t j = 0; j < 3 * n; j++)
        coder->mean[j] = (float)mean[j];
    return RELUME_OK;
}

static relume_status prepare(relume_coder *coder, const struct relume_log *log)
{
    if (coder->decode)
        return RELUME_OK;
    const struct relume_samples *s = coder->samples;
    if (!s || s->lights != coder->info.lights || !s->pixels)
        return log_fail(log, RELUME_EINVAL, "basis pca learns from samples of the capture");
    const int dim = 3 * coder->info.lights, k = coder->info.coefficients;
    const size_t d = (size_t)dim;
    double *mean = mem_zeroed(d, sizeof *mean);
    double *gram = mem_zeroed(d * d, sizeof *gram);
    double *values = mem_array((size_t)k, sizeof *values);
    double *vectors = mem_array((size_t)k * d, sizeof *vectors);
    relume_status status = mean && gram && values && vectors ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = find_mean(s, d, mean);
    if (!status)
        status = find_covariance(s, dim, mean, gram);
    if (!status && !lsq_eigenvectors(gram, dim, k, values, vectors))
        status = RELUME_ENOMEM;
    if (!status)
        status = keep(coder, mean, vectors);
    free(mean);
    free(gram);
    free(values);
    free(vectors);
    return status;
}

static void release(relume_coder *coder)
{
    (void)coder;
}

const struct relume_basis relume_basis_pca = {
    .name = "pca",
    .summary = "principal components of the capture, R, G, B together; any number of coefficients",
    .interpolates = true,
    .learned = true,
    .fit_count = fit_count,
    .has_count = has_count,
    .prepare = prepare,
    .evaluate = coder_interpolate,
    .release = release,
};
