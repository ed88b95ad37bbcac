// basis_linear.c - one file that a line in `relume_bases` makes a basis of the tool: 1 and the
// direction itself, by least squares (tests/cli/test_growing.sh)
#include "format/coder/basis.h"

extern const struct relume_basis relume_basis_linear;

static int fit_count(int want, int lights)
{
    return (want == 0 || want >= 4) && lights >= 4 ? 4 : 0;
}

static bool has_count(int count)
{
    return count == 4;
}

static void evaluate(const relume_coder *coder, struct relume_vec3 light, double *values)
{
    (void)coder;
    const double v[] = {1.0, light.x, light.y, light.z};
    for (int i = 0; i < 4; i++)
        values[i] = v[i];
}

static relume_status prepare(relume_coder *coder, const struct relume_log *log)
{
    static const double roughness[] = {0.0, 1.0, 1.0, 1.0};
    return coder->decode ? RELUME_OK : fit_map(coder, roughness, log);
}

static void release(relume_coder *coder)
{
    (void)coder;
}

const struct relume_basis relume_basis_linear = {
    .name = "linear",
    .summary = "a constant and the direction of the light, of four coefficients",
    .fits = true,
    .fit_count = fit_count,
    .has_count = has_count,
    .prepare = prepare,
    .evaluate = evaluate,
    .release = release,
};
