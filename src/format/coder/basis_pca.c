// basis_pca.c - principal components of the reflectance table, joint over R, G, B
//
// A pixel's 3 N samples are written as mean + sum_k c_k function_k (pca.c). Between the lights both
// are interpolated: b_k,c(L) = sum_i a_i(L) function_k[c, i], a being the weights of the
// interpolant, which matters more than the number of components.
#include "core/base/log.h"
#include "core/base/memory.h"
#include "format/coder/pca.h"

enum { DEFAULT_COUNT = 27 };

static int fit_count(int want, int lights)
{
    const int most = want ? want : DEFAULT_COUNT;
    return most > 3 * lights ? 3 * lights : most;
}

// Functions and mean are stored, the analysis is the encoding map.
static relume_status keep(relume_coder *coder, const struct components *found)
{
    const size_t k = (size_t)coder->info.coefficients, n = (size_t)coder->info.lights;
    coder->map = mem_array(3 * k * n, sizeof *coder->map);
    coder->base = mem_array(k, sizeof *coder->base);
    coder->transform = mem_array(3 * k * n, sizeof *coder->transform);
    coder->mean = mem_array(3 * n, sizeof *coder->mean);
    if (!coder->map || !coder->base || !coder->transform || !coder->mean)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < k; i++) {
        double base = 0.0;
        for (size_t c = 0; c < 3; c++)
            for (size_t j = 0; j < n; j++) {
                const size_t at = (i * 3 + c) * n + j;
                coder->map[at] = (float)found->analysis[at];
                coder->transform[(c * k + i) * n + j] = (float)found->function[at];
                base -= found->analysis[at] * found->mean[c * n + j];
            }
        coder->base[i] = (float)base;
    }
    for (size_t j = 0; j < 3 * n; j++)
        coder->mean[j] = (float)found->mean[j];
    return RELUME_OK;
}

static relume_status prepare(relume_coder *coder, const struct relume_log *log)
{
    if (coder->decode)
        return RELUME_OK;
    const struct relume_samples *s = coder->samples;
    if (!s || s->lights != coder->info.lights || !s->pixels)
        return log_fail(log, RELUME_EINVAL, "basis pca learns from samples of the capture");
    struct components found;
    relume_status status = components_find(&found, coder);
    if (!status)
        status = keep(coder, &found);
    components_destroy(&found);
    return status;
}

const struct relume_basis relume_basis_pca = {
    .name = "pca",
    .summary = "principal components of the capture, R, G, B together; any number of coefficients",
    .interpolates = true,
    .learned = true,
    .joint = true,
    .fits = true,
    .fit_count = fit_count,
    .has_count = basis_takes_any,
    .prepare = prepare,
    .evaluate = coder_interpolate,
};
