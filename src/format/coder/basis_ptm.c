// basis_ptm.c - polynomial texture maps (Malzbender, Gelb, Wolters 2001): the biquadratic
// polynomial of the light's projection, x^2, y^2, x y, x, y, 1, or its linear part
#include "format/coder/basis.h"
#include "format/coder/coding.h"

enum { LINEAR = 3, BIQUADRATIC = 6 };

static bool has_count(int count)
{
    return count == LINEAR || count == BIQUADRATIC;
}

static int fit_count(int want, int lights)
{
    const int most = want && want < lights ? want : lights;
    return most >= BIQUADRATIC ? BIQUADRATIC : most >= LINEAR ? LINEAR : 0;
}

static relume_status prepare(relume_coder *coder, const struct relume_log *log)
{
    static const double roughness[BIQUADRATIC] = {1, 1, 1, 0, 0, 0};
    const int skip = BIQUADRATIC - coder->info.coefficients;
    return coder->decode ? RELUME_OK : fit_map(coder, roughness + skip, log);
}

static void evaluate(const relume_coder *coder, struct relume_vec3 light, double *values)
{
    const double x = light.x, y = light.y;
    const double terms[BIQUADRATIC] = {x * x, y * y, x * y, x, y, 1.0};
    for (int i = 0, skip = BIQUADRATIC - coder->info.coefficients; skip + i < BIQUADRATIC; i++)
        values[i] = terms[skip + i];
}

const struct relume_basis relume_basis_ptm = {
    .name = "ptm",
    .summary = "polynomial texture map: x^2 y^2 xy x y 1; 3 or 6 coefficients, hemisphere",
    .upper_only = true,
    .halves = true,
    .fits = true,
    .fit_count = fit_count,
    .has_count = has_count,
    .prepare = prepare,
    .evaluate = evaluate,
};
