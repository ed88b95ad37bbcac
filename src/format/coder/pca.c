// pca.c - principal components for relighting
//
// Plain components minimise the error at the captured lights. What is looked at are lights between
// them: with a(d) the interpolant's weights at direction d and R the residual of a pixel, the error
// there is |a(d)' R|^2. Summed over directions with weights w_d this is the metric
//     M = sum_d w_d a(d) a(d)' / sum_d w_d   + 1 % of its mean eigenvalue on the diagonal,
// alike for each colour; components of M^1/2 t are optimal in it, and orthonormal, so that one
// quantiser step serves all. A second round weighs each direction by the inverse of the error that
// remains there - decibels are won where little is left - on top of what interpolation itself
// misses there, ln e = alpha + beta z fitted to the errors of captured lights left out. Sets of
// more than 400 lights are dense enough to be their own metric.
#include "format/coder/pca.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/lsq.h"
#include "format/coder/interpolant.h"
#include "format/coder/sums.h"

#include <string.h>

enum { DENSE = 400, RINGS = 12, AZIMUTHS = 40, DIRECTIONS = RINGS * AZIMUTHS };

struct solver {
    const relume_coder *coder;
    struct components *out;
    size_t lights, dim;
    double *covariance;            // [dim][dim]
    double *weights;               // [DIRECTIONS][lights]: a(d)
    double expected[DIRECTIONS];   // squared error of interpolation at d
    double emphasis[DIRECTIONS];   // w_d
    double *metric;                // [lights][lights]: M
    double *root, *inverse;        // [lights][lights]: M^1/2, M^-1/2
    double *product, *transposed;  // [dim][dim]
    double *values;                // [count]
};

void components_destroy(struct components *c)
{
    mem_free(c->mean);
    mem_free(c->analysis);
    mem_free(c->function);
    *c = (struct components){0};
}

static void free_solver(struct solver *s)
{
    mem_free(s->covariance);
    mem_free(s->weights);
    mem_free(s->metric);
    mem_free(s->root);
    mem_free(s->inverse);
    mem_free(s->product);
    mem_free(s->transposed);
    mem_free(s->values);
}

static bool alloc_solver(struct solver *s)
{
    const size_t n = s->lights, d = s->dim, k = (size_t)s->out->count;
    s->out->mean = mem_zeroed(d, sizeof(double));
    s->out->analysis = mem_array(k * d, sizeof(double));
    s->out->function = mem_array(k * d, sizeof(double));
    s->covariance = mem_zeroed(d * d, sizeof(double));
    s->weights = mem_array(DIRECTIONS * n, sizeof(double));
    s->metric = mem_array(n * n, sizeof(double));
    s->root = mem_array(n * n, sizeof(double));
    s->inverse = mem_array(n * n, sizeof(double));
    s->product = mem_array(d * d, sizeof(double));
    s->transposed = mem_array(d * d, sizeof(double));
    s->values = mem_array(k, sizeof(double));
    return s->out->mean && s->out->analysis && s->out->function && s->covariance && s->weights &&
           s->metric && s->root && s->inverse && s->product && s->transposed && s->values;
}

// ---------------------------------------------------------------- directions

// Rings of equal steps in elevation between the lowest and the highest light.
static void choose_directions(const struct solver *s, vec3 *d)
{
    double low = 1.0, high = -1.0;
    for (size_t i = 0; i < s->lights; i++) {
        low = fmin(low, s->coder->frame[i].z);
        high = fmax(high, s->coder->frame[i].z);
    }
    low = asin(fmax(low, -1.0));
    high = asin(fmin(high, 1.0));
    for (int ring = 0; ring < RINGS; ring++)
        for (int i = 0; i < AZIMUTHS; i++) {
            const double elevation = low + (high - low) * ring / (RINGS - 1);
            const double phi = 2.0 * M_PI * (i + 0.5 * (ring % 2)) / AZIMUTHS;
            d[ring * AZIMUTHS + i] =
                vec3_of(cos(phi) * cos(elevation), sin(phi) * cos(elevation), sin(elevation));
        }
}

// ln(error) = alpha + beta z by least squares.
static void fit_errors(const struct solver *s, const double *error, double *alpha, double *beta)
{
    const double n = (double)s->lights;
    double z = 0.0, e = 0.0, zz = 0.0, ze = 0.0;
    for (size_t i = 0; i < s->lights; i++) {
        z += s->coder->frame[i].z / n;
        e += log(error[i]) / n;
    }
    for (size_t i = 0; i < s->lights; i++) {
        const double dz = s->coder->frame[i].z - z;
        zz += dz * dz;
        ze += dz * (log(error[i]) - e);
    }
    *beta = zz > 1e-9 ? ze / zz : 0.0;
    *alpha = e - *beta * z;
}

// Interpolants that do not know their error are assumed to miss a constant part of the signal.
static relume_status expect_errors(struct solver *s, const vec3 *d)
{
    const size_t n = s->lights;
    double *gram = mem_array(n * n, sizeof *gram), *b = mem_array(n * n, sizeof *b);
    double *error = mem_array(n, sizeof *error);
    relume_status status = gram && b && error ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = samples_gram(gram, s->coder->samples, s->coder->threads);
    if (!status) {
        const struct relume_interpolant *between = s->coder->info.interpolant;
        double alpha, beta;
        if (between->predictor) {
            between->predictor(s->coder->interpolant, b);
            predict_errors(error, b, gram, (int)n);
        } else
            for (size_t i = 0; i < n; i++)
                error[i] = 1e-6 + 1e-2 * gram[i * n + i];
        fit_errors(s, error, &alpha, &beta);
        for (int i = 0; i < DIRECTIONS; i++)
            s->expected[i] = 0.5 * exp(alpha + beta * d[i].z);
    }
    mem_free(gram);
    mem_free(b);
    mem_free(error);
    return status;
}

// ---------------------------------------------------------------- the metric

// Rows scaled by sqrt(w) give M as a Gram matrix; its eigenvectors give the roots.
static relume_status find_metric(struct solver *s)
{
    const size_t n = s->lights;
    double total = 0.0, trace = 0.0;
    double *row = mem_array(n, sizeof *row);
    if (!row)
        return RELUME_ENOMEM;
    memset(s->metric, 0, n * n * sizeof *s->metric);
    for (int i = 0; i < DIRECTIONS; i++)
        total += s->emphasis[i];
    for (int i = 0; i < DIRECTIONS; i++) {
        for (size_t j = 0; j < n; j++)
            row[j] = s->weights[(size_t)i * n + j] * sqrt(s->emphasis[i] / total);
        lsq_add_gram(s->metric, (int)n, row, 1);
    }
    mem_free(row);
    for (size_t j = 0; j < n; j++)
        trace += s->metric[j * n + j];
    for (size_t j = 0; j < n; j++)
        s->metric[j * n + j] += 0.01 * trace / (double)n;
    return lsq_roots(s->metric, (int)n, s->root, s->inverse) ? RELUME_OK : RELUME_ENOMEM;
}

// out = block diagonal (h, h, h) x in
static void multiply_blocks(const struct solver *s, const double *h, const double *in, double *out)
{
    const int n = (int)s->lights, dim = (int)s->dim;
    for (int c = 0; c < 3; c++)
        lsq_multiply_double(n, dim, n, h, in + (size_t)(c * n) * s->dim,
                            out + (size_t)(c * n) * s->dim);
}

static void transpose(const double *in, size_t n, double *out)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            out[j * n + i] = in[i * n + j];
}

// The largest components of M^1/2 C M^1/2, turned back.
static relume_status find_components(struct solver *s)
{
    const size_t n = s->lights, dim = s->dim;
    struct components *o = s->out;
    multiply_blocks(s, s->root, s->covariance, s->product);
    transpose(s->product, dim, s->transposed);
    multiply_blocks(s, s->root, s->transposed, s->product);
    if (!lsq_eigenvectors(s->product, (int)dim, o->count, s->values, o->analysis))
        return RELUME_ENOMEM;
    for (size_t i = 0; i < 3 * (size_t)o->count; i++)  // a row of vectors is (component, channel)
        for (size_t j = 0; j < n; j++) {
            double sum = 0.0;
            for (size_t l = 0; l < n; l++)
                sum += s->inverse[j * n + l] * o->analysis[i * n + l];
            o->function[i * n + j] = sum;
        }
    for (size_t i = 0; i < 3 * (size_t)o->count; i++) {
        double row[RELUME_MOST_COEFFICIENTS];
        memcpy(row, o->analysis + i * n, n * sizeof *row);
        for (size_t j = 0; j < n; j++) {
            double sum = 0.0;
            for (size_t l = 0; l < n; l++)
                sum += s->root[j * n + l] * row[l];
            o->analysis[i * n + j] = sum;
        }
    }
    return RELUME_OK;
}

// w_d = 1 / (what the components leave at d + what interpolation misses there)
static void emphasise(struct solver *s)
{
    const size_t n = s->lights, dim = s->dim;
    double *left = s->metric;  // the mean covariance of the residual over the channels
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            double sum = 0.0;
            for (size_t c = 0; c < 3; c++) {
                sum += s->covariance[(c * n + i) * dim + c * n + j];
                for (size_t k = 0; k < (size_t)s->out->count; k++) {
                    const double *u = s->out->function + k * dim + c * n;
                    sum -= s->values[k] * u[i] * u[j];
                }
            }
            left[i * n + j] = sum / 3.0;
        }
    for (int d = 0; d < DIRECTIONS; d++) {
        const double *a = s->weights + (size_t)d * n;
        double error = s->expected[d];
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++)
                error += a[i] * left[i * n + j] * a[j];
        s->emphasis[d] = 1.0 / fmax(error, 1e-12);
    }
}

static relume_status solve_dense(struct solver *s)
{
    struct components *o = s->out;
    if (!lsq_eigenvectors(s->covariance, (int)s->dim, o->count, s->values, o->analysis))
        return RELUME_ENOMEM;
    memcpy(o->function, o->analysis, (size_t)o->count * s->dim * sizeof *o->function);
    return RELUME_OK;
}

static relume_status solve(struct solver *s)
{
    vec3 d[DIRECTIONS];
    relume_status status =
        samples_covariance(s->out->mean, s->covariance, s->coder->samples, s->coder->threads);
    if (!status && s->lights > DENSE)
        return solve_dense(s);
    choose_directions(s, d);
    for (int i = 0; i < DIRECTIONS; i++) {
        coder_interpolate(s->coder, d[i], s->weights + (size_t)i * s->lights);
        s->emphasis[i] = 1.0;
    }
    if (!status)
        status = expect_errors(s, d);
    for (int step = 0; !status && step < 2; step++) {
        status = find_metric(s);
        if (!status)
            status = find_components(s);
        if (!status && !step)
            emphasise(s);
    }
    return status;
}

relume_status components_find(struct components *out, const relume_coder *coder)
{
    const int n = coder->info.lights;
    *out = (struct components){.count = coder->info.coefficients, .lights = n};
    struct solver s = {.coder = coder, .out = out, .lights = (size_t)n, .dim = 3 * (size_t)n};
    const relume_status status = alloc_solver(&s) ? solve(&s) : RELUME_ENOMEM;
    free_solver(&s);
    if (status)
        components_destroy(out);
    return status;
}
