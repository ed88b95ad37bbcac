// sums.c - what learning adds up of samples: once for all lights, of which a coder may have some
#include "format/coder/sums.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/gram.h"

#include <string.h>

static void values_of(const void *context, size_t first, size_t count, double *out)
{
    const struct relume_samples *s = context;
    const size_t n = (size_t)s->lights, values = 3 * s->pixels;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < count; j++)
            out[j * n + i] = (double)s->data[i * values + first + j];
}

relume_status samples_gram(double *gram, const struct relume_samples *s, int threads)
{
    const size_t n = (size_t)s->lights, values = 3 * s->pixels;
    if (s->sums) {
        memcpy(gram, s->sums->gram, n * n * sizeof *gram);
        return RELUME_OK;
    }
    const relume_status status = gram_sum(gram, n, values, values_of, s, threads);
    for (size_t i = 0; !status && i < n * n; i++)
        gram[i] /= (double)values;
    return status;
}

struct moments {
    const struct relume_samples *samples;
    size_t lights;
    double *mean;
};

// The means of one light's three channels, by sums of every fourth pixel: they do not wait for each
// other.
static void find_mean(void *context, size_t light, int worker)
{
    (void)worker;
    const struct moments *m = context;
    const size_t n = 3 * m->samples->pixels;
    const float *data = m->samples->data + light * n;
    double sum[12] = {0.0};
    for (size_t i = 0; i < n - n % 12; i += 12)
        for (size_t k = 0; k < 12; k++)
            sum[k] += (double)data[i + k];
    for (size_t i = n - n % 12; i < n; i++)
        sum[i % 12] += (double)data[i];
    for (size_t c = 0; c < 3; c++)
        m->mean[c * m->lights + light] =
            (sum[c] + sum[c + 3] + sum[c + 6] + sum[c + 9]) / (double)m->samples->pixels;
}

// Samples of pixels as [channel][light], less their means.
static void centre(const void *context, size_t first, size_t count, double *out)
{
    const struct moments *m = context;
    const size_t dim = 3 * m->lights;
    for (size_t i = 0; i < m->lights; i++) {
        const float *data = m->samples->data + (i * m->samples->pixels + first) * 3;
        for (size_t x = 0; x < count; x++)
            for (size_t c = 0; c < 3; c++) {
                const size_t j = c * m->lights + i;
                out[x * dim + j] = (double)data[3 * x + c] - m->mean[j];
            }
    }
}

relume_status samples_covariance(double *mean, double *covariance, const struct relume_samples *s,
                                 int threads)
{
    struct moments m = {s, (size_t)s->lights, mean};
    const size_t dim = 3 * m.lights;
    if (s->sums) {
        memcpy(mean, s->sums->mean, dim * sizeof *mean);
        memcpy(covariance, s->sums->covariance, dim * dim * sizeof *covariance);
        return RELUME_OK;
    }
    thread_for(threads, m.lights, find_mean, &m);
    const relume_status status = gram_sum(covariance, dim, s->pixels, centre, &m, threads);
    for (size_t i = 0; i < dim * dim; i++)
        covariance[i] /= (double)s->pixels;
    return status;
}

// ---------------------------------------------------------------- some of the lights

void sample_sums_free(struct relume_sample_sums *s)
{
    mem_free(s->gram);
    mem_free(s->mean);
    mem_free(s->covariance);
    *s = (struct relume_sample_sums){0};
}

// Allocates what is asked for and not there.
static bool allocate_sums(struct relume_sample_sums *s, int lights, bool learned)
{
    const size_t n = (size_t)lights;
    s->lights = lights;
    if (!s->gram)
        s->gram = mem_zeroed(n * n, sizeof *s->gram);
    if (learned && !s->mean)
        s->mean = mem_zeroed(3 * n, sizeof *s->mean);
    if (learned && !s->covariance)
        s->covariance = mem_zeroed(9 * n * n, sizeof *s->covariance);
    return s->gram && (!learned || (s->mean && s->covariance));
}

relume_status sample_sums_make(struct relume_sample_sums *s, const struct relume_samples *samples,
                               bool learned, int threads)
{
    const bool has_gram = s->gram, has_covariance = s->covariance;
    relume_status status = allocate_sums(s, samples->lights, learned) ? RELUME_OK : RELUME_ENOMEM;
    if (!status && !has_gram)
        status = samples_gram(s->gram, samples, threads);
    if (!status && learned && !has_covariance)
        status = samples_covariance(s->mean, s->covariance, samples, threads);
    if (status)
        sample_sums_free(s);
    return status;
}

relume_status sample_sums_pick(struct relume_sample_sums *out, const struct relume_sample_sums *all,
                               const int *light, int n)
{
    const size_t count = (size_t)n, lights = (size_t)all->lights;
    *out = (struct relume_sample_sums){0};
    if (!allocate_sums(out, n, all->covariance != NULL)) {
        sample_sums_free(out);
        return RELUME_ENOMEM;
    }
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < count; j++)
            out->gram[i * count + j] = all->gram[(size_t)light[i] * lights + (size_t)light[j]];
    for (size_t i = 0; out->covariance && i < 3 * count; i++) {
        const size_t from = i / count * lights + (size_t)light[i % count];
        const double *row = all->covariance + from * 3 * lights;
        out->mean[i] = all->mean[from];
        for (size_t j = 0; j < 3 * count; j++)
            out->covariance[i * 3 * count + j] = row[j / count * lights + (size_t)light[j % count]];
    }
    return RELUME_OK;
}
