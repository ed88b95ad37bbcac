// interpolant_choice.c - what lies between pictures that are kept themselves: flat triangles of
// their lights, or the kernel
//
// Some lights are left out, one at a time, and foretold by all others, as a file foretells
// those that were never captured.
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "encode/choose/samples.h"
#include "format/coder/coding.h"
#include "format/coder/interpolant.h"

#include <math.h>
#include <string.h>

// Trying takes long where there are more lights, and what lies between them is little.
enum { FEWEST = 8, MOST_LIGHTS = 400, LEFT_OUT = 32, NUGGET = 2 };
static const double MOST_DB = 60.0;  // of one light: exact black must not hide others

struct trial {
    const struct relume_manifest *manifest;
    const struct relume_coder_params *coder;
    const struct relume_samples *samples;
    double *decibels;       // [left]
    relume_status *status;  // [left]
    int left;
};

// What the others say of a light is missed by so much, in dB.
static double miss(const struct trial *t, int light, const float *weight)
{
    const struct relume_samples *s = t->samples;
    const size_t n = 3 * s->pixels;
    double sum = 0.0;
    for (size_t x = 0; x < n; x++) {
        double value = 0.0;
        for (int i = 0, k = 0; i < s->lights; i++)
            if (i != light)
                value += (double)weight[k++] * (double)s->data[(size_t)i * n + x];
        const double missed = fmin(fmax(value, 0.0), 1.0) -
                              fmin(fmax((double)s->data[(size_t)light * n + x], 0.0), 1.0);
        sum += missed * missed;
    }
    return fmin(decibels(sum / (double)n), MOST_DB);
}

static void leave_out(void *context, size_t item, int worker)
{
    (void)worker;
    struct trial *t = context;
    const int lights = t->manifest->lights, light = (int)item * lights / t->left;
    struct relume_vec3 *others = mem_array((size_t)lights, sizeof *others);
    float *weight = mem_array(3 * (size_t)lights, sizeof *weight), constant[3];
    relume_coder *coder = NULL;
    t->status[item] = others && weight ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0, k = 0; others && i < lights; i++)
        if (i != light)
            others[k++] = t->manifest->directions[i];
    if (!t->status[item])
        t->status[item] =
            relume_coder_create(&coder, &relume_basis_table, others, lights - 1, t->coder);
    if (!t->status[item]) {
        relume_coder_weights(coder, t->manifest->directions[light], weight, constant);
        t->decibels[item] = miss(t, light, weight);
    }
    relume_coder_destroy(&coder);
    mem_free(others);
    mem_free(weight);
}

static relume_status judge(double *mean, struct trial *t, int threads)
{
    relume_status status = RELUME_OK;
    thread_for(threads, (size_t)t->left, leave_out, t);
    *mean = 0.0;
    for (int i = 0; i < t->left; i++) {
        status = status ? status : t->status[i];
        *mean += t->decibels[i] / t->left;
    }
    return status;
}

static relume_status compare(struct relume_coder_params *flat, struct relume_coder_params *curved,
                             const struct relume_manifest *m, const struct relume_samples *samples,
                             bool *better)
{
    double score[2] = {0.0, 0.0};
    struct trial t = {.manifest = m, .samples = samples};
    t.left = m->lights < LEFT_OUT ? m->lights : LEFT_OUT;
    t.decibels = mem_zeroed((size_t)t.left, sizeof *t.decibels);
    t.status = mem_zeroed((size_t)t.left, sizeof *t.status);
    relume_status status = t.decibels && t.status ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < 2; i++) {
        t.coder = i ? curved : flat;
        status = judge(&score[i], &t, flat->threads);
    }
    *better = score[1] > score[0];
    mem_free(t.decibels);
    mem_free(t.status);
    return status;
}

// The parameters that `choose` finds; smoothing would cost quality before coding does.
static relume_status find_parameters(struct relume_coder_params *curved,
                                     const struct relume_manifest *m,
                                     const struct relume_samples *samples)
{
    struct relume_coder_params p = *curved;
    relume_coder *coder;
    p.choose = true;
    p.samples = samples;
    const relume_status status =
        relume_coder_create(&coder, &relume_basis_table, m->directions, m->lights, &p);
    if (status)
        return status;
    curved->interpolant = relume_coder_info(coder)->interpolant;
    memcpy(curved->parameter, relume_coder_info(coder)->parameter, sizeof curved->parameter);
    curved->parameter[NUGGET] = 0.0;
    relume_coder_destroy(&coder);
    return RELUME_OK;
}

relume_status relume_coder_between(struct relume_coder_params *coder, const relume_capture *capture,
                                   const struct relume_project_params *encode)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    struct relume_samples samples = {0};
    struct relume_coder_params flat = PARAMS_WORK(relume_coder_params, coder);
    bool better = false;
    flat.log = NULL;
    flat.coefficients = 0;
    flat.choose = false;
    flat.interpolant = &interpolant_delaunay;
    flat.hemispherical = relume_capture_hemispherical(capture);
    flat.pole_y = relume_capture_pole_y(capture);
    flat.threads = encode ? encode->threads : 0;
    memset(flat.parameter, 0, sizeof flat.parameter);
    struct relume_coder_params curved = flat;
    coder->choose = false;
    coder->interpolant = flat.interpolant;
    memset(coder->parameter, 0, sizeof coder->parameter);
    if (m->lights < FEWEST || m->lights > MOST_LIGHTS)
        return RELUME_OK;
    relume_status status =
        relume_samples_read(&samples, capture, samples_enough(m->lights), encode);
    if (!status && samples.pixels)
        status = find_parameters(&curved, m, &samples);
    if (!status && samples.pixels)
        status = compare(&flat, &curved, m, &samples, &better);
    if (!status && better) {
        coder->interpolant = curved.interpolant;
        memcpy(coder->parameter, curved.parameter, sizeof coder->parameter);
    }
    relume_samples_destroy(&samples);
    return status;
}
