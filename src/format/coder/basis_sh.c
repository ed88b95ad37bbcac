// basis_sh.c - real spherical harmonics (Wong 1998, 9.1.1 and appendix A), (degree + 1)^2 of them,
// fitted by least squares on the captured directions
#include "core/math/sh.h"
#include "format/coder/harmonics.h"

static bool has_count(int count)
{
    return harmonics_degree(count) >= 0;
}

static int fit_count(int want, int lights)
{
    return harmonics_fit_count(want, lights, 25, SH_MAX_DEGREE);
}

static void evaluate(const relume_coder *coder, struct relume_vec3 light, double *values)
{
    sh_evaluate(harmonics_degree(coder->info.coefficients), light, values);
}

const struct relume_basis relume_basis_sh = {
    .name = "sh",
    .summary = "spherical harmonics, 1 4 9 16 25 36 49 64 ... coefficients",
    .fits = true,
    .fit_count = fit_count,
    .has_count = has_count,
    .prepare = harmonics_prepare,
    .evaluate = evaluate,
};
