// interpolant_kernel.c - radial kernels with a trend
//
// With the kernel phi of two directions and the trend p, the value at d is
// sum_i a_i phi(l_i, d) + sum_t b_t p_t(d), where
//     [ Phi + nugget I   P ] [a]   [t]
//     [ Pt               0 ] [b] = [0]            t: the captured samples
// so that the weights of the samples at d are the first N rows of the inverse times (phi(d), p(d)).
// Without a nugget the captured samples are reproduced exactly; a nugget smooths. B, the first N x
// N block of the inverse, also gives the error of predicting light i from all others: (B t)_i /
// B_ii (Dubrule 1983), without solving again.
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "format/coder/basis.h"
#include "format/coder/interpolant.h"

#include <string.h>

enum { MAX_TREND = 4 };

struct kernel {
    double (*phi)(const double *parameter, vec3 a, vec3 b);
    double parameter[4];
    int lights, trend;
    vec3 *light;
    double *inverse;  // [lights + trend][lights + trend], columns side by side
};

// ---------------------------------------------------------------- kernels

// The linear kernel on the angle.
static double angular(const double *parameter, vec3 a, vec3 b)
{
    (void)parameter;
    return -vec3_angle(a, b);
}

// The thin plate spline on the chord.
static double thin_plate(const double *parameter, vec3 a, vec3 b)
{
    (void)parameter;
    const vec3 d = vec3_sub(a, b);
    const double square = vec3_dot(d, d);
    return square > 0.0 ? 0.5 * square * log(square) : 0.0;
}

enum { WIDTH };  // of Gaussians, among the parameters

// Gaussians of the chord.
static double gaussian(const double *parameter, vec3 a, vec3 b)
{
    const vec3 d = vec3_sub(a, b);
    return exp(-vec3_dot(d, d) / (parameter[WIDTH] * parameter[WIDTH]));
}

// The five harmonics of degree 2, without their common factor.
static void second_degree(vec3 d, double *q)
{
    q[0] = d.x * d.y;
    q[1] = d.y * d.z;
    q[2] = d.x * d.z;
    q[3] = (d.x * d.x - d.y * d.y) / 2.0;
    q[4] = (3.0 * d.z * d.z - 1.0) / sqrt(12.0);
}

enum { POWER, STRETCH, NUGGET, SECOND_DEGREE };

// A power of the chord, the pole's axis stretched, with a trend of first degree (a wide prior) and
// one of second degree (a prior of the given strength).
static double chord(const double *parameter, vec3 a, vec3 b)
{
    static const double FIRST_DEGREE = 30.0;
    const vec3 d = vec3_sub(a, b);
    const double z = parameter[STRETCH] * d.z;
    const double square = d.x * d.x + d.y * d.y + z * z;
    double value = FIRST_DEGREE * vec3_dot(a, b) - (parameter[POWER] == 1.5
                                                        ? sqrt(square * sqrt(square))
                                                        : pow(square, parameter[POWER] / 2.0));
    if (parameter[SECOND_DEGREE] > 0.0) {
        double p[5], q[5];
        second_degree(a, p);
        second_degree(b, q);
        for (int i = 0; i < 5; i++)
            value += parameter[SECOND_DEGREE] * p[i] * q[i];
    }
    return value;
}

// ---------------------------------------------------------------- the system

static void fill_row(const struct kernel *k, vec3 d, double *row)
{
    const double trend[MAX_TREND] = {1.0, d.x, d.y, d.z};
    for (int i = 0; i < k->lights; i++)
        row[i] = k->phi(k->parameter, k->light[i], d);
    for (int i = 0; i < k->trend; i++)
        row[k->lights + i] = trend[i];
}

// Coinciding lights and degenerate trends stay solvable by `least` on the diagonal.
static relume_status invert(struct kernel *k, double least)
{
    const size_t n = (size_t)k->lights, size = n + (size_t)k->trend;
    for (size_t i = 0; i < n; i++) {
        fill_row(k, k->light[i], k->inverse + i * size);
        k->inverse[i * size + i] += least + k->parameter[NUGGET];
        for (size_t j = n; j < size; j++)
            k->inverse[j * size + i] = k->inverse[i * size + j];
    }
    for (size_t i = n; i < size; i++)
        for (size_t j = n; j < size; j++)
            k->inverse[i * size + j] = i == j ? -1e-9 : 0.0;
    return lsq_invert(k->inverse, (int)size);
}

// So that weights are sums of columns, which run through memory in order.
static void transpose(double *a, size_t n)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++) {
            const double kept = a[i * n + j];
            a[i * n + j] = a[j * n + i];
            a[j * n + i] = kept;
        }
}

static void release(void *data)
{
    struct kernel *k = data;
    mem_free(k->light);
    mem_free(k->inverse);
    mem_free(k);
}

static relume_status prepare(void **data, struct kernel kind, double least,
                             const struct relume_vec3 *lights, int n, const struct relume_log *log)
{
    struct kernel *k = *data = mem_copy(&kind, 1, sizeof kind);
    if (!k)
        return RELUME_ENOMEM;
    const size_t size = (size_t)n + (size_t)k->trend;
    k->lights = n;
    k->light = mem_copy(lights, (size_t)n, sizeof *lights);
    k->inverse = mem_array(size * size, sizeof *k->inverse);
    relume_status status = k->light && k->inverse ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = invert(k, least);
    if (!status)
        transpose(k->inverse, size);
    if (status == RELUME_EUNFIT)
        (void)log_fail(
            log, status,
            "the %d light directions are too few or too much alike to interpolate between", n);
    if (status) {
        release(k);
        *data = NULL;
    }
    return status;
}

static void add_scaled(double *restrict to, const double *restrict from, double factor, int n)
{
    for (int i = 0; i < n; i++)
        to[i] += factor * from[i];
}

static void evaluate(const void *data, struct relume_vec3 light, double *weights)
{
    const struct kernel *k = data;
    double row[RELUME_MOST_COEFFICIENTS + MAX_TREND];
    const int size = k->lights + k->trend;
    fill_row(k, light, row);
    memset(weights, 0, (size_t)k->lights * sizeof *weights);
    for (int j = 0; j < size; j++)
        add_scaled(weights, k->inverse + (size_t)j * (size_t)size, row[j], k->lights);
}

// ---------------------------------------------------------------- the interpolants

static bool spans_both(const struct relume_vec3 *lights, int n)
{
    double lowest = 1.0;
    for (int i = 0; i < n; i++)
        lowest = fmin(lowest, lights[i].z);
    return lowest < -0.1;
}

// z joins the trend when there are lights on both hemispheres; on one it nearly follows from x and
// y.
static int linear_trend(const struct relume_vec3 *lights, int n)
{
    return spans_both(lights, n) ? 4 : 3;
}

static relume_status prepare_angular(void **data, const struct relume_vec3 *lights, int n,
                                     const double *parameter, const struct relume_log *log)
{
    (void)parameter;
    const struct kernel kind = {.phi = angular, .trend = linear_trend(lights, n)};
    return prepare(data, kind, 1e-9, lights, n, log);
}

static relume_status prepare_thin_plate(void **data, const struct relume_vec3 *lights, int n,
                                        const double *parameter, const struct relume_log *log)
{
    (void)parameter;
    const struct kernel kind = {.phi = thin_plate, .trend = linear_trend(lights, n)};
    return prepare(data, kind, 1e-9, lights, n, log);
}

// Menzel 2011, 4.5, with a constant, for what is far from all lights, and a width that goes with
// them: his is 1, for 253 over the sphere.
static relume_status prepare_gaussian(void **data, const struct relume_vec3 *lights, int n,
                                      const double *parameter, const struct relume_log *log)
{
    struct kernel kind = {.phi = gaussian, .trend = 1};
    kind.parameter[WIDTH] =
        parameter[0] > 0.0 ? parameter[0] : 2.0 * interpolant_spacing(lights, n);
    return prepare(data, kind, 1e-6, lights, n, log);
}

static relume_status prepare_chord(void **data, const struct relume_vec3 *lights, int n,
                                   const double *parameter, const struct relume_log *log)
{
    struct kernel kind = {.phi = chord, .trend = 1};
    memcpy(kind.parameter, parameter, sizeof kind.parameter);
    if (!(kind.parameter[POWER] > 0.0))
        kind.parameter[POWER] = 1.5;
    if (!(kind.parameter[STRETCH] > 0.0))
        kind.parameter[STRETCH] = spans_both(lights, n) ? 1.0 : 1.5;
    if (kind.parameter[POWER] >= 2.0 || kind.parameter[STRETCH] > 100.0)
        return log_fail(log, RELUME_EUNFIT,
                        "interpolant chord: expected a power below 2 and a stretch of at most 100, "
                        "found %g and %g",
                        kind.parameter[POWER], kind.parameter[STRETCH]);
    return prepare(data, kind, 1e-5, lights, n, log);
}

static void predictor(const void *data, double *b)
{
    const struct kernel *k = data;
    const size_t n = (size_t)k->lights, size = n + (size_t)k->trend;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            b[i * n + j] = k->inverse[j * size + i];
}

const struct relume_interpolant interpolant_chord = {
    .name = "chord",
    .summary =
        "kernel of a power of the chord between lights, with a trend; the best on most captures",
    .extrapolates = true,
    .prepare = prepare_chord,
    .evaluate = evaluate,
    .release = release,
    .predictor = predictor,
};

const struct relume_interpolant interpolant_gaussian = {
    .name = "gaussian",
    .summary = "Gaussians around the lights, weighed so that these are reproduced",
    .extrapolates = false,
    .prepare = prepare_gaussian,
    .evaluate = evaluate,
    .release = release,
    .predictor = predictor,
};

const struct relume_interpolant interpolant_angular = {
    .name = "angular",
    .summary = "kernel linear in the angle between lights, with a linear trend",
    .extrapolates = true,
    .prepare = prepare_angular,
    .evaluate = evaluate,
    .release = release,
    .predictor = predictor,
};

const struct relume_interpolant interpolant_tps = {
    .name = "tps",
    .summary = "thin plate spline on the chord between lights, with a linear trend",
    .extrapolates = true,
    .prepare = prepare_thin_plate,
    .evaluate = evaluate,
    .release = release,
    .predictor = predictor,
};
