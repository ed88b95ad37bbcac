// basis_sh.c - real spherical harmonics (Wong 1998, 9.1.1 and appendix A), (degree + 1)^2 of them,
// fitted by least squares on the captured directions
#include "coder/basis.h"
#include "math/sh.h"

#include <math.h>

static int degree_of(int count)
{
    const int degree = (int)lround(sqrt(count)) - 1;
    return degree >= 0 && degree <= SH_MAX_DEGREE && (degree + 1) * (degree + 1) == count ? degree
                                                                                          : -1;
}

static bool has_count(int count)
{
    return count >= 1 && degree_of(count) >= 0;
}

// By itself half as many coefficients as lights, at most 25: more fit the noise.
static int fit_count(int want, int lights)
{
    int most = want ? want : lights / 2 < 25 ? lights / 2 : 25;
    most = most < 1 ? 1 : most > lights ? lights : most;
    int degree = 0;
    while (degree < SH_MAX_DEGREE && (degree + 2) * (degree + 2) <= most)
        degree++;
    return (degree + 1) * (degree + 1);
}

// The Laplacian's eigenvalue squared: bending, which noise has and reflectance has little of.
static relume_status prepare(relume_coder *coder, const struct relume_log *log)
{
    double roughness[(SH_MAX_DEGREE + 1) * (SH_MAX_DEGREE + 1)];
    const int degree = degree_of(coder->info.coefficients);
    for (int l = 0, k = 0; l <= degree; l++)
        for (int m = -l; m <= l; m++)
            roughness[k++] = (double)(l * (l + 1)) * (double)(l * (l + 1));
    return coder->decode ? RELUME_OK : fit_map(coder, roughness, log);
}

static void evaluate(const relume_coder *coder, struct relume_vec3 light, double *values)
{
    sh_evaluate(degree_of(coder->info.coefficients), light, values);
}

static void release(relume_coder *coder)
{
    (void)coder;
}

const struct relume_basis relume_basis_sh = {
    .name = "sh",
    .summary = "spherical harmonics, 1 4 9 16 25 36 49 64 ... coefficients",
    .fit_count = fit_count,
    .has_count = has_count,
    .prepare = prepare,
    .evaluate = evaluate,
    .release = release,
};
