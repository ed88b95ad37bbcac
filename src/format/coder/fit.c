// fit.c - least squares for smooth bases
//
// Coefficients c of a pixel with samples t at the captured directions minimise
//     |Y c - t|^2 / N  +  fill |V c - F t|^2 / M  +  ridge sum_k roughness_k c_k^2
// Y: basis at the N captured directions. V: basis at M directions where nothing was captured, F:
// what is assumed there. Wong 1998, 9.1.4: only a hemisphere is usually captured and zeros below it
// ring, so the values run linearly from the equator to a constant at the far pole; the constant
// here is the mean over the equator. The assumed samples weigh little: they decide what the
// captured ones leave open, and they keep the system well conditioned.
//
// With H the matrix of that quadratic form and H = L Lt, the stored functions are b' = L^-1 b and
// the stored coefficients c' = Lt c: orthonormal over the captured directions, so that an error in
// any stored coefficient costs equally much and 8 bits suffice.
#include "format/coder/basis.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/lsq.h"

#include <stdio.h>
#include <string.h>

enum { FILL_SAMPLES = 256, EQUATOR_SAMPLES = 64 };
static const double FILL_WEIGHT = 1e-4;
static const double DEFAULT_RIDGE = 1e-6;
// Eigenvalues of Yt Y / N below this part of the largest mean that the lights say nothing at all.
static const double RANK_TOLERANCE = 1e-13;

struct system {
    int n, k, m;  // lights, coefficients, assumed samples
    double *y;    // [n][k]
    double *v;    // [m][k]
    double *f;    // [m][n]
    double *h;    // [k][k]
    double *b;    // [k][n]
};

static bool alloc_system(struct system *s)
{
    const size_t n = (size_t)s->n, k = (size_t)s->k, m = (size_t)s->m;
    s->y = mem_array(n * k, sizeof(double));
    s->v = mem_array(m * k, sizeof(double));
    s->f = mem_zeroed(m * n, sizeof(double));
    s->h = mem_zeroed(k * k, sizeof(double));
    s->b = mem_zeroed(k * n, sizeof(double));
    return s->y && s->v && s->f && s->h && s->b;
}

// a[k][k] += weight rows^T rows for rows[count][k]
static void add_gram(double *a, int k, const double *rows, int count, double weight)
{
    for (int r = 0; r < count; r++)
        for (int i = 0; i < k; i++)
            for (int j = 0; j < k; j++)
                a[i * k + j] += weight * rows[r * k + i] * rows[r * k + j];
}

static relume_status refuse_rank(const struct system *s, const struct relume_basis *basis, int rank,
                                 const struct relume_log *log)
{
    // The most coefficients of the basis that so many directions determine, 0 where there are none.
    int most = rank;
    while (most > 0 && !basis->has_count(most))
        most--;
    char instead[64] = "";
    if (most)
        snprintf(instead, sizeof instead, ", or at most %d coefficient%s", most,
                 relume_plural(most));
    return log_fail(log, RELUME_EUNFIT,
                    "the %d light directions determine only %d of %d coefficients; expected lights "
                    "spread in both angles%s",
                    s->n, rank, s->k, instead);
}

static relume_status check_rank(const struct system *s, const relume_coder *coder,
                                const struct relume_log *log)
{
    const size_t k = (size_t)s->k;
    double *gram = mem_zeroed(k * k, sizeof *gram), *values = mem_array(k, sizeof *values);
    relume_status status = gram && values ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        add_gram(gram, s->k, s->y, s->n, 1.0 / s->n);
        if (!lsq_eigenvalues(gram, s->k, values))
            status = RELUME_ENOMEM;
    }
    int rank = 0;
    for (int i = 0; !status && i < s->k; i++)
        rank += values[i] > RANK_TOLERANCE * values[s->k - 1];
    const bool open = coder->no_ridge && s->m == 0;  // nothing would decide what lights leave open
    if (!status && rank < s->k && coder->force && !open)
        log_line(log, RELUME_WARNING,
                 "the %d light directions determine only %d of %d coefficients", s->n, rank, s->k);
    else if (!status && rank < s->k)
        status = refuse_rank(s, coder->info.basis, rank, log);
    mem_free(gram);
    mem_free(values);
    return status;
}

// Directions of the uncaptured hemisphere (equal areas) and the captured samples that stand there;
// for bases whose functions end at the horizon, directions on it.
static relume_status assume_far_side(struct system *s, const relume_coder *coder)
{
    mesh *lights;
    const relume_status status = mesh_create(&lights, coder->frame, s->n);
    if (status)
        return status;
    const size_t n = (size_t)s->n;
    double *mean = mem_zeroed(n, sizeof *mean);
    if (!mean) {
        mesh_destroy(&lights);
        return RELUME_ENOMEM;
    }
    for (int i = 0; i < EQUATOR_SAMPLES; i++) {
        const double phi = 2.0 * M_PI * i / EQUATOR_SAMPLES;
        const struct blend b = mesh_blend(lights, vec3_of(cos(phi), sin(phi), 0.0));
        for (int j = 0; j < b.count; j++)
            mean[b.light[j]] += b.weight[j] / EQUATOR_SAMPLES;
    }
    for (int i = 0; i < s->m; i++) {
        const double z = coder->info.basis->halves ? 0.0 : -(i + 0.5) / s->m;
        const double r = sqrt(1.0 - z * z);
        const double phi = i * (M_PI * (3.0 - sqrt(5.0)));
        const vec3 d = vec3_of(r * cos(phi), r * sin(phi), z);
        const double towards_pole = acos(r) / (M_PI / 2.0);
        const struct blend b = mesh_blend(lights, vec3_of(cos(phi), sin(phi), 0.0));
        double *f = s->f + (size_t)i * n;
        for (size_t j = 0; j < n; j++)
            f[j] = towards_pole * mean[j];
        for (int j = 0; j < b.count; j++)
            f[b.light[j]] += (1.0 - towards_pole) * b.weight[j];
        coder->info.basis->evaluate(coder, d, s->v + (size_t)i * (size_t)s->k);
    }
    mem_free(mean);
    mesh_destroy(&lights);
    return RELUME_OK;
}

static void assemble(struct system *s, const double *roughness, double ridge)
{
    const int n = s->n, k = s->k;
    add_gram(s->h, k, s->y, n, 1.0 / n);
    add_gram(s->h, k, s->v, s->m, FILL_WEIGHT / (s->m ? s->m : 1));
    for (int i = 0; i < k; i++)
        s->h[i * k + i] += ridge * roughness[i];
    for (int i = 0; i < k; i++)
        for (int j = 0; j < n; j++) {
            double sum = s->y[j * k + i] / n;
            for (int r = 0; r < s->m; r++)
                sum += FILL_WEIGHT / s->m * s->v[r * k + i] * s->f[r * n + j];
            s->b[i * n + j] = sum;
        }
}

// map = Lt H^-1 B = L^-1 B and transform = L^-1.
static relume_status finish(struct system *s, relume_coder *coder, const struct relume_log *log)
{
    const size_t n = (size_t)s->n, k = (size_t)s->k;
    if (!lsq_cholesky(s->h, s->k) || !lsq_invert_lower(s->h, s->k))
        return log_fail(log, RELUME_EUNFIT,
                        "the light directions are too few or too much alike for %d coefficients of "
                        "basis %s; use fewer coefficients",
                        s->k, coder->info.basis->name);
    coder->map = mem_array(k * n, sizeof *coder->map);
    coder->transform = mem_array(k * k, sizeof *coder->transform);
    if (!coder->map || !coder->transform)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < k; i++) {
        for (size_t j = 0; j < n; j++) {
            double sum = 0.0;
            for (size_t l = 0; l <= i; l++)
                sum += s->h[i * k + l] * s->b[l * n + j];
            coder->map[i * n + j] = (float)sum;
        }
        for (size_t j = 0; j < k; j++)
            coder->transform[i * k + j] = (float)s->h[i * k + j];
    }
    return RELUME_OK;
}

relume_status fit_map(relume_coder *coder, const double *roughness, const struct relume_log *log)
{
    struct system s = {.n = coder->info.lights,
                       .k = coder->info.coefficients,
                       .m = coder->info.hemispherical ? FILL_SAMPLES : 0};
    if (coder->info.ridge == 0.0 && !coder->no_ridge)
        coder->info.ridge = DEFAULT_RIDGE;
    relume_status status = alloc_system(&s) ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        for (int i = 0; i < s.n; i++)
            coder->info.basis->evaluate(coder, coder->frame[i], s.y + (size_t)i * (size_t)s.k);
        status = check_rank(&s, coder, log);
    }
    if (!status && s.m)
        status = assume_far_side(&s, coder);
    if (!status) {
        assemble(&s, roughness, coder->info.ridge);
        status = finish(&s, coder, log);
    }
    mem_free(s.y);
    mem_free(s.v);
    mem_free(s.f);
    mem_free(s.h);
    mem_free(s.b);
    return status;
}
