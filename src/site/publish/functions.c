// functions.c - the numbers of a file as coefficients of its coder's raw functions
#include "site/publish/functions.h"

#include <string.h>

// Row c of number i in the file's own functions, [F]; NULL: raw function i itself.
static const float *row_of(const struct relume_coder_info *info, int c, int i)
{
    const size_t f = (size_t)info->functions;
    if (!info->transform)
        return NULL;
    return info->transform + (size_t)(info->basis->joint ? c * info->coefficients + i : i) * f;
}

void functions_add(double *to, const struct relume_coder_info *info, int c, const double *x)
{
    for (int i = 0; i < info->coefficients; i++) {
        const double v = x[info->basis->joint ? i : 3 * i + c];
        const float *row = row_of(info, c, i);
        if (!row)
            to[i] += v;
        for (int f = 0; row && f < info->functions; f++)
            to[f] += v * (double)row[f];
    }
}

relume_status functions_coder(relume_coder **out, const struct relume_coder_info *info,
                              const struct relume_log *log)
{
    struct relume_coder_params p = {.struct_size = sizeof p,
                                    .log = log,
                                    .hemispherical = info->hemispherical,
                                    .pole_y = info->pole_y,
                                    .interpolant = info->interpolant,
                                    .force = true,
                                    .decode = true};
    if (!info->basis->interpolates)
        p.coefficients = info->functions;
    memcpy(p.parameter, info->parameter, sizeof p.parameter);
    return relume_coder_create(out, info->basis->interpolates ? &relume_basis_table : info->basis,
                               info->directions, info->lights, &p);
}
