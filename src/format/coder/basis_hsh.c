// basis_hsh.c - hemispherical harmonics (core/math/hsh.h), (degree + 1)^2 of them, fitted by least
// squares
#include "core/math/hsh.h"
#include "format/coder/coding.h"
#include "format/coder/harmonics.h"

static bool has_count(int count)
{
    const int degree = harmonics_degree(count);
    return degree >= 0 && degree <= HSH_MAX_DEGREE;
}

static int fit_count(int want, int lights)
{
    return harmonics_fit_count(want, lights, 16, HSH_MAX_DEGREE);
}

static void evaluate(const relume_coder *coder, struct relume_vec3 light, double *values)
{
    hsh_evaluate(harmonics_degree(coder->info.coefficients), light, values);
}

const struct relume_basis relume_basis_hsh = {
    .name = "hsh",
    .summary = "hemispherical harmonics, 1 4 9 16 25 coefficients, hemisphere",
    .upper_only = true,
    .halves = true,
    .fits = true,
    .fit_count = fit_count,
    .has_count = has_count,
    .prepare = harmonics_prepare,
    .evaluate = evaluate,
};
