// interpolant_hsh.c - nine hemispherical harmonics by regularised least squares: smooths noise, at
// the price of not meeting the captured values
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/hsh.h"
#include "core/math/lsq.h"
#include "format/coder/basis.h"
#include "format/coder/interpolant.h"

#include <string.h>

enum { DEGREE = 2, TERMS = (DEGREE + 1) * (DEGREE + 1) };
static const double DEFAULT_RIDGE = 0.1;  // of nine terms against the sum over all lights

struct trend {
    int lights;
    double *weight;  // [lights][TERMS]
};

static void release(void *data)
{
    struct trend *t = data;
    mem_free(t->weight);
    mem_free(t);
}

static relume_status solve(struct trend *t, const struct relume_vec3 *lights, double ridge)
{
    double gram[TERMS * TERMS] = {0};
    double *rows = mem_array((size_t)t->lights * TERMS, sizeof *rows);
    if (!rows)
        return RELUME_ENOMEM;
    for (int i = 0; i < t->lights; i++)
        hsh_evaluate(DEGREE, lights[i], rows + i * TERMS);
    lsq_add_gram(gram, TERMS, rows, t->lights);
    for (int i = 0; i < TERMS; i++)
        gram[i * TERMS + i] += i ? ridge : 1e-9;
    const relume_status status = lsq_invert(gram, TERMS);
    for (int i = 0; !status && i < t->lights; i++)
        for (int j = 0; j < TERMS; j++) {
            double sum = 0.0;
            for (int k = 0; k < TERMS; k++)
                sum += gram[j * TERMS + k] * rows[i * TERMS + k];
            t->weight[i * TERMS + j] = sum;
        }
    mem_free(rows);
    return status;
}

// parameter[0]: the ridge.
static relume_status prepare(void **data, const struct relume_vec3 *lights, int n,
                             const double *parameter, const struct relume_log *log)
{
    double lowest = 1.0;
    for (int i = 0; i < n; i++)
        lowest = fmin(lowest, lights[i].z);
    if (lowest < -0.1)
        return log_fail(
            log, RELUME_EUNFIT,
            "interpolant hsh covers one hemisphere of lights; found lights on both sides");
    struct trend *t = *data = mem_zeroed(1, sizeof *t);
    if (!t)
        return RELUME_ENOMEM;
    t->lights = n;
    t->weight = mem_array((size_t)n * TERMS, sizeof *t->weight);
    const relume_status status =
        t->weight ? solve(t, lights, parameter[0] > 0.0 ? parameter[0] : DEFAULT_RIDGE)
                  : RELUME_ENOMEM;
    if (status) {
        release(t);
        *data = NULL;
    }
    return status;
}

static void evaluate(const void *data, struct relume_vec3 light, double *weights)
{
    const struct trend *t = data;
    double values[TERMS];
    hsh_evaluate(DEGREE, light, values);
    for (int i = 0; i < t->lights; i++) {
        weights[i] = 0.0;
        for (int j = 0; j < TERMS; j++)
            weights[i] += t->weight[i * TERMS + j] * values[j];
    }
}

const struct relume_interpolant interpolant_hsh = {
    .name = "hsh",
    .summary = "nine hemispherical harmonics by least squares; smooths noise",
    .extrapolates = true,
    .prepare = prepare,
    .evaluate = evaluate,
    .release = release,
};
