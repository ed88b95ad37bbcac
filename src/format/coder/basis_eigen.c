// basis_eigen.c - eigenimages: pictures in R, G and B, weighted by the light alone
//
// Menzel 2011, chapter 4. The photographs are the columns of a matrix M, whose rows run over the
// colours of all pixels; no mean is taken from it. With g_k the leading unit eigenvectors of M^T M,
//     M ~ sum_k e_k g_k^T,     e_k = M g_k
// are the eigenimages, and a light's weight is its entry of g_k, interpolated between the lights as
// those of `pca` are. In the domain of logarithms that is the thesis's method. M^T M is summed up
// and solved (the exact variant); a few terms of thousands of lights are found sooner by Lanczos's
// method, 4 K steps from a white image w, here seen from the lights: M^T times the Krylov space of
// M M^T from w is that of M^T M from M^T w.
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/lanczos.h"
#include "core/math/lsq.h"
#include "format/coder/basis.h"
#include "format/coder/coding.h"
#include "format/coder/sums.h"

#include <string.h>

enum { DEFAULT_COUNT = 16, STEPS_EACH = 4, PARTS = 32, BLOCK = 2048 };

static int fit_count(int want, int lights)
{
    const int most = want ? want : DEFAULT_COUNT;
    return most > lights ? lights : most;
}

// ---------------------------------------------------------------- products with M^T M

struct pictures {
    const struct relume_samples *samples;
    size_t lights, values;
    int threads;
    double *part;  // [PARTS][lights]
};

struct multiplying {
    const struct pictures *p;
    const double *v;  // [lights]; NULL: M v is white
};

// Blocks of a part's values: y = M v, then M^T y.
static void multiply_part(void *context, size_t item, int worker)
{
    (void)worker;
    const struct multiplying *m = context;
    const struct pictures *p = m->p;
    const size_t end = (item + 1) * p->values / PARTS;
    double *out = p->part + item * p->lights, y[BLOCK];
    memset(out, 0, p->lights * sizeof *out);
    for (size_t first = item * p->values / PARTS, n; first < end; first += n) {
        n = end - first < BLOCK ? end - first : BLOCK;
        for (size_t x = 0; x < n; x++)
            y[x] = m->v ? 0.0 : 1.0;
        for (size_t i = 0; m->v && i < p->lights; i++) {
            const float *data = p->samples->data + i * p->values + first;
            for (size_t x = 0; x < n; x++)
                y[x] += m->v[i] * (double)data[x];
        }
        for (size_t i = 0; i < p->lights; i++) {
            const float *data = p->samples->data + i * p->values + first;
            double sum[4] = {0.0};
            for (size_t x = 0; x < n; x++)
                sum[x % 4] += (double)data[x] * y[x];
            out[i] += sum[0] + sum[1] + sum[2] + sum[3];
        }
    }
}

static void multiply(const struct pictures *p, const double *v, double *out)
{
    struct multiplying m = {p, v};
    thread_for(p->threads, PARTS, multiply_part, &m);
    memset(out, 0, p->lights * sizeof *out);
    for (size_t part = 0; part < PARTS; part++)
        for (size_t i = 0; i < p->lights; i++)
            out[i] += p->part[part * p->lights + i];
}

static void multiply_product(const void *context, const double *v, double *out)
{
    multiply(context, v, out);
}

// ---------------------------------------------------------------- vectors of the lights

relume_status eigen_by_steps(double *vectors, int count, const struct relume_samples *s,
                             int threads)
{
    const size_t n = (size_t)s->lights;
    struct pictures p = {s, n, 3 * s->pixels, threads, mem_array(PARTS * n, sizeof *p.part)};
    double *start = mem_array(n, sizeof *start);
    double *values = mem_array((size_t)count, sizeof *values);
    relume_status status = p.part && start && values ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        multiply(&p, NULL, start);
        status = lanczos_eigenvectors(s->lights, count, STEPS_EACH * count, start, multiply_product,
                                      &p, values, vectors);
    }
    mem_free(p.part);
    mem_free(start);
    mem_free(values);
    return status;
}

relume_status eigen_by_gram(double *vectors, int count, const struct relume_samples *s, int threads)
{
    const size_t n = (size_t)s->lights;
    double *gram = mem_array(n * n, sizeof *gram);
    double *values = mem_array((size_t)count, sizeof *values);
    relume_status status = gram && values ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = samples_gram(gram, s, threads);
    if (!status && !lsq_eigenvectors(gram, s->lights, count, values, vectors))
        status = RELUME_ENOMEM;
    mem_free(gram);
    mem_free(values);
    return status;
}

// ---------------------------------------------------------------- the basis

static relume_status keep(relume_coder *coder, const double *vectors)
{
    const size_t size = (size_t)coder->info.coefficients * (size_t)coder->info.lights;
    coder->map = mem_array(size, sizeof *coder->map);
    coder->transform = mem_array(size, sizeof *coder->transform);
    if (!coder->map || !coder->transform)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < size; i++)
        coder->map[i] = coder->transform[i] = (float)vectors[i];
    return RELUME_OK;
}

static relume_status prepare(relume_coder *coder, const struct relume_log *log)
{
    // A product with M^T M takes as long as a 64th of the lights' part of summing it up: measured
    // with 250 to 4000 lights.
    enum { LIGHTS_A_STEP = 64 };
    if (coder->decode)
        return RELUME_OK;
    const struct relume_samples *s = coder->samples;
    const int count = coder->info.coefficients;
    if (!s || s->lights != coder->info.lights || !s->pixels)
        return log_fail(log, RELUME_EINVAL, "basis eigen learns from samples of the capture");
    double *vectors = mem_array((size_t)count * (size_t)s->lights, sizeof *vectors);
    const bool few = !s->sums && LIGHTS_A_STEP * STEPS_EACH * count <= s->lights;
    relume_status status = !vectors ? RELUME_ENOMEM
                           : few    ? eigen_by_steps(vectors, count, s, coder->threads)
                                    : eigen_by_gram(vectors, count, s, coder->threads);
    if (!status)
        status = keep(coder, vectors);
    mem_free(vectors);
    return status;
}

const struct relume_basis relume_basis_eigen = {
    .name = "eigen",
    .summary = "eigenimages in R, G and B; with --domain log for high dynamic range",
    .interpolates = true,
    .learned = true,
    .fits = true,
    .fit_count = fit_count,
    .has_count = basis_takes_any,
    .prepare = prepare,
    .evaluate = coder_interpolate,
};
