// basis_hsh.c - hemispherical harmonics (math/hsh.h), (degree + 1)^2 of them, fitted by least
// squares
#include "coder/basis.h"
#include "math/hsh.h"

static bool has_count(int count)
{
    return count == 1 || count == 4 || count == 9 || count == 16 || count == 25;
}

// By itself half as many coefficients as lights, at most 16.
static int fit_count(int want, int lights)
{
    int most = want ? want : lights / 2 < 16 ? lights / 2 : 16;
    most = most < 1 ? 1 : most > lights ? lights : most;
    int degree = 0;
    while (degree < HSH_MAX_DEGREE && (degree + 2) * (degree + 2) <= most)
        degree++;
    return (degree + 1) * (degree + 1);
}

static int degree_of(int count)
{
    return (int)lround(sqrt(count)) - 1;
}

// As for spherical harmonics: bending.
static relume_status prepare(relume_coder *coder, const struct relume_log *log)
{
    double roughness[(HSH_MAX_DEGREE + 1) * (HSH_MAX_DEGREE + 1)];
    const int degree = degree_of(coder->info.coefficients);
    for (int l = 0, k = 0; l <= degree; l++)
        for (int m = -l; m <= l; m++)
            roughness[k++] = (double)(l * (l + 1)) * (double)(l * (l + 1));
    return coder->decode ? RELUME_OK : fit_map(coder, roughness, log);
}

static void evaluate(const relume_coder *coder, struct relume_vec3 light, double *values)
{
    hsh_evaluate(degree_of(coder->info.coefficients), light, values);
}

static void release(relume_coder *coder)
{
    (void)coder;
}

const struct relume_basis relume_basis_hsh = {
    .name = "hsh",
    .summary = "hemispherical harmonics, 1 4 9 16 25 coefficients, hemisphere",
    .upper_only = true,
    .halves = true,
    .fit_count = fit_count,
    .has_count = has_count,
    .prepare = prepare,
    .evaluate = evaluate,
    .release = release,
};
