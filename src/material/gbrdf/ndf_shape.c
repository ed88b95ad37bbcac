// ndf_shape.c - distributions of micro-normals made wider, and made up
#include "material/gbrdf/ndf.h"

#include "core/math/scalar.h"

#include <string.h>

// A direction of a cell, (i, j) of n x n within it; off the disc, that of the rim beside it, for
// what is interpolated there.
static vec3 within_cell(int column, int row, int i, int j, int n)
{
    double u = 2.0 * (column + (i + 0.5) / n) / NDF_SIDE - 1.0,
           v = 2.0 * (row + (j + 0.5) / n) / NDF_SIDE - 1.0;
    const double far = sqrt(u * u + v * v), rim = 0.999;
    if (far > rim) {
        u *= rim / far;
        v *= rim / far;
    }
    const double r2 = u * u + v * v;
    return vec3_scale(vec3_of(2.0 * u, 2.0 * v, 1.0 - r2), 1.0 / (1.0 + r2));
}

// What the micro-normals cover of the plane: the integral of value x cosine.
static void covered(double sum[3], const float *ndf)
{
    sum[0] = sum[1] = sum[2] = 0.0;
    for (int j = 0; j < NDF_SIDE; j++)
        for (int i = 0; i < NDF_SIDE; i++) {
            vec3 h;
            if (!ndf_direction(i, j, NDF_SIDE, &h))
                continue;
            const double share = h.z * ndf_solid_angle((1.0 - h.z) / (1.0 + h.z), NDF_SIDE);
            for (int c = 0; c < 3; c++)
                sum[c] += share * (double)ndf[3 * (j * NDF_SIDE + i) + c];
        }
}

static void cover(float *ndf, const double wanted[3])
{
    double sum[3];
    covered(sum, ndf);
    for (int c = 0; c < 3; c++)
        for (int i = c; i < NDF_VALUES && sum[c] > 0.0; i += 3)
            ndf[i] = (float)((double)ndf[i] * wanted[c] / sum[c]);
}

// At the slopes divided by `factor`; the density of slopes falls with its square, that of
// directions is the density of slopes over the fourth power of the cosine.
static void add_widened(float rgb[3], const float *ndf, vec3 h, double factor)
{
    const vec3 from = vec3_of(h.x, h.y, factor * h.z);
    const double length2 = vec3_dot(from, from);
    float value[3];
    ndf_at(ndf, vec3_unit(from), value);
    for (int c = 0; c < 3; c++)
        rgb[c] += (float)((double)value[c] * factor * factor / (length2 * length2));
}

void ndf_widen(float *ndf, double factor)
{
    const int n = smaller_of((int)ceil(fmax(1.0 / factor, 1.0)), 16);
    float old[NDF_VALUES];
    double sum[3];
    memcpy(old, ndf, sizeof old);
    covered(sum, old);
    memset(ndf, 0, sizeof old);
    for (int at = 0; at < NDF_SIDE * NDF_SIDE; at++)
        for (int k = 0; k < n * n; k++)
            add_widened(ndf + 3 * at, old,
                        within_cell(at % NDF_SIDE, at / NDF_SIDE, k % n, k / n, n), factor);
    cover(ndf, sum);
}

void ndf_ggx(float *ndf, double alpha, const double rgb[3])
{
    enum { N = 16 };
    for (int at = 0; at < NDF_SIDE * NDF_SIDE; at++) {
        double sum = 0.0;
        for (int k = 0; k < N * N; k++) {
            const vec3 h = within_cell(at % NDF_SIDE, at / NDF_SIDE, k % N, k / N, N);
            const double spread = h.z * h.z * (alpha * alpha - 1.0) + 1.0;
            sum += alpha * alpha / (M_PI * spread * spread) / (N * N);
        }
        for (int c = 0; c < 3; c++)
            ndf[3 * at + c] = (float)(rgb[c] * sum);
    }
    cover(ndf, (const double[3]){0.25 * rgb[0], 0.25 * rgb[1], 0.25 * rgb[2]});
}
