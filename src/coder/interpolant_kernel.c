// interpolant_kernel.c - radial kernels with a linear trend, met exactly at the lights
//
// With the kernel phi of the angle or chord between directions and the trend p = (1, x, y[, z]),
// the value at d is sum_i a_i phi(l_i, d) + sum_t b_t p_t(d), where
//     [ Phi  P ] [a]   [t]
//     [ Pt   0 ] [b] = [0]            t: the captured samples
// so that the weights of the samples at d are the first N rows of the inverse times (phi(d), p(d)).
// z joins the trend when there are lights on both hemispheres; on one it follows from x and y
// nearly.
#include "base/log.h"
#include "base/memory.h"
#include "coder/basis.h"
#include "coder/interpolant.h"
#include "math/lsq.h"

enum { MAX_TREND = 4 };
// Relative to the largest kernel value: keeps coinciding lights and degenerate trends solvable.
static const double NUGGET = 1e-9;

struct kernel {
    double (*phi)(vec3 a, vec3 b);
    int lights, trend;
    vec3 *light;
    double *inverse;  // [lights][lights + trend]
};

// The linear kernel on the angle.
static double angular(vec3 a, vec3 b)
{
    return -vec3_angle(a, b);
}

// The thin plate spline on the chord.
static double thin_plate(vec3 a, vec3 b)
{
    const vec3 d = vec3_sub(a, b);
    const double square = vec3_dot(d, d);
    return square > 0.0 ? 0.5 * square * log(square) : 0.0;
}

static void fill_row(const struct kernel *k, vec3 d, double *row)
{
    const double trend[MAX_TREND] = {1.0, d.x, d.y, d.z};
    for (int i = 0; i < k->lights; i++)
        row[i] = k->phi(k->light[i], d);
    for (int i = 0; i < k->trend; i++)
        row[k->lights + i] = trend[i];
}

static void release(void *data)
{
    struct kernel *k = data;
    free(k->light);
    free(k->inverse);
    free(k);
}

static bool invert(struct kernel *k)
{
    const size_t n = (size_t)k->lights, size = n + (size_t)k->trend;
    double largest = 0.0;
    for (size_t i = 0; i < n; i++) {
        fill_row(k, k->light[i], k->inverse + i * size);
        for (size_t j = 0; j < n; j++)
            largest = fmax(largest, fabs(k->inverse[i * size + j]));
    }
    for (size_t i = 0; i < n; i++) {
        k->inverse[i * size + i] += NUGGET * largest;
        for (size_t j = n; j < size; j++)
            k->inverse[j * size + i] = k->inverse[i * size + j];
    }
    for (size_t i = n; i < size; i++)
        for (size_t j = n; j < size; j++)
            k->inverse[i * size + j] = i == j ? -NUGGET : 0.0;
    return lsq_invert(k->inverse, (int)size);
}

static relume_status prepare(void **data, const struct relume_vec3 *lights, int n,
                             double (*phi)(vec3, vec3), const struct relume_log *log)
{
    struct kernel *k = *data = mem_zeroed(1, sizeof *k);
    if (!k)
        return RELUME_ENOMEM;
    double lowest = 1.0;
    for (int i = 0; i < n; i++)
        lowest = fmin(lowest, lights[i].z);
    *k = (struct kernel){.phi = phi, .lights = n, .trend = lowest < -0.1 ? 4 : 3};
    const size_t size = (size_t)n + (size_t)k->trend;
    k->light = mem_copy(lights, (size_t)n, sizeof *lights);
    k->inverse = mem_array(size * size, sizeof *k->inverse);
    relume_status status = k->light && k->inverse ? RELUME_OK : RELUME_ENOMEM;
    if (!status && !invert(k))
        status =
            log_fail(log, RELUME_EDATA, "the %d light directions leave the interpolant open", n);
    if (status) {
        release(k);
        *data = NULL;
    }
    return status;
}

static relume_status prepare_angular(void **data, const struct relume_vec3 *lights, int n,
                                     const double *parameter, const struct relume_log *log)
{
    (void)parameter;
    return prepare(data, lights, n, angular, log);
}

static relume_status prepare_thin_plate(void **data, const struct relume_vec3 *lights, int n,
                                        const double *parameter, const struct relume_log *log)
{
    (void)parameter;
    return prepare(data, lights, n, thin_plate, log);
}

static void evaluate(const void *data, struct relume_vec3 light, double *weights)
{
    const struct kernel *k = data;
    double row[CODER_MAX_COEFFICIENTS + MAX_TREND];
    const int size = k->lights + k->trend;
    fill_row(k, light, row);
    for (int i = 0; i < k->lights; i++) {
        double sum = 0.0;
        for (int j = 0; j < size; j++)
            sum += k->inverse[(size_t)i * (size_t)size + (size_t)j] * row[j];
        weights[i] = sum;
    }
}

const struct relume_interpolant interpolant_angular = {
    .name = "angular",
    .summary = "kernel linear in the angle between lights, with a linear trend",
    .prepare = prepare_angular,
    .evaluate = evaluate,
    .release = release,
};

const struct relume_interpolant interpolant_tps = {
    .name = "tps",
    .summary = "thin plate spline on the chord between lights, with a linear trend",
    .prepare = prepare_thin_plate,
    .evaluate = evaluate,
    .release = release,
};
