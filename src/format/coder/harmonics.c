// harmonics.c - counts and roughness of (degree + 1)^2 harmonics, degree by degree
#include "core/math/sh.h"
#include "format/coder/harmonics.h"

#include <math.h>

int harmonics_degree(int count)
{
    int degree = 0;
    while (degree < SH_MAX_DEGREE && (degree + 1) * (degree + 1) < count)
        degree++;
    return (degree + 1) * (degree + 1) == count ? degree : -1;
}

int harmonics_fit_count(int want, int lights, int plenty, int most_degree)
{
    int most = want ? want : lights / 2 < plenty ? lights / 2 : plenty;
    most = most < 1 ? 1 : most > lights ? lights : most;
    int degree = 0;
    while (degree < most_degree && (degree + 2) * (degree + 2) <= most)
        degree++;
    return (degree + 1) * (degree + 1);
}

relume_status harmonics_prepare(relume_coder *coder, const struct relume_log *log)
{
    double roughness[(SH_MAX_DEGREE + 1) * (SH_MAX_DEGREE + 1)];
    const int degree = harmonics_degree(coder->info.coefficients);
    for (int l = 0, k = 0; l <= degree; l++)
        for (int m = -l; m <= l; m++)
            roughness[k++] = (double)(l * (l + 1)) * (double)(l * (l + 1));
    return coder->decode ? RELUME_OK : fit_map(coder, roughness, log);
}
