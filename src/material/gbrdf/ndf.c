// ndf.c - distributions of micro-normals on the parabolic map
#include "material/gbrdf/ndf.h"

#include "core/math/bilinear.h"
#include "material/gbrdf/brdf.h"

#include <string.h>

bool ndf_direction(int column, int row, int side, vec3 *h)
{
    const double u = (2.0 * column + 1.0) / side - 1.0, v = (2.0 * row + 1.0) / side - 1.0;
    const double r2 = u * u + v * v;
    *h = vec3_scale(vec3_of(2.0 * u, 2.0 * v, 1.0 - r2), 1.0 / (1.0 + r2));
    return r2 < 1.0;
}

double ndf_solid_angle(double r2, int side)
{
    const double cell = 2.0 / side, near = 1.0 + r2;
    return cell * cell * 4.0 / (near * near);
}

void ndf_at(const float *ndf, vec3 h, float rgb[3])
{
    double at[2];
    ndf_place(h, NDF_SIDE, at);
    const struct bilinear b =
        bilinear_at(at[0] - 0.5, at[1] - 0.5, NDF_SIDE, NDF_SIDE, EDGE_CLAMPED);
    for (size_t c = 0; c < 3; c++)
        rgb[c] = bilinear_valuef(&b, ndf, 3, c);
}

// ---------------------------------------------------------------- gaps

// Half as wide: means by weight, whose sum is cut at 1.
static void pull(float *value, float *weight, const float *fine, const float *fine_weight, int side)
{
    for (int j = 0; j < side; j++)
        for (int i = 0; i < side; i++) {
            float sum = 0.0f, all = 0.0f;
            for (int k = 0; k < 4; k++) {
                const int at = (2 * j + k / 2) * 2 * side + 2 * i + k % 2;
                sum += fine_weight[at] * fine[at];
                all += fine_weight[at];
            }
            value[j * side + i] = all > 0.0f ? sum / all : 0.0f;
            weight[j * side + i] = fminf(all, 1.0f);
        }
}

void ndf_fill(float *value, const float *weight, int side)
{
    float coarse[NDF_SIDE * NDF_SIDE / 4], coarse_weight[NDF_SIDE * NDF_SIDE / 4] = {0.0f};
    const int half = side / 2;
    if (side == 1) {
        value[0] = weight[0] > 0.0f ? value[0] : 0.0f;
        return;
    }
    pull(coarse, coarse_weight, value, weight, half);
    ndf_fill(coarse, coarse_weight, half);
    for (int j = 0; j < side; j++)
        for (int i = 0; i < side; i++) {
            const struct bilinear b =
                bilinear_at(0.5 * i - 0.25, 0.5 * j - 0.25, half, half, EDGE_CLAMPED);
            const float own = fminf(weight[j * side + i], 1.0f);
            float *to = &value[j * side + i];
            *to =
                (own > 0.0f ? own * *to : 0.0f) + (1.0f - own) * bilinear_valuef(&b, coarse, 1, 0);
        }
}

// ---------------------------------------------------------------- energy

// What one cell adds: light from `k1` is mirrored by facets that face `h` into 4 k1.h times their
// solid angle.
static void reflect(struct ndf_albedo *out, int from, vec3 k1, vec3 h, double solid,
                    const float value[3])
{
    const double kh = vec3_dot(k1, h);
    const vec3 k2 = vec3_sub(vec3_scale(h, 2.0 * kh), k1);
    if (kh <= 0.0 || k2.z <= 0.0)
        return;
    const double share = 4.0 * kh * solid * k2.z / brdf_masking(k1.z, k2.z);
    for (int c = 0; c < 3; c++) {
        out->from[from].all[c] += share * (double)value[c];
        out->from[from].grazing[c] += share * (double)value[c] * brdf_grazing(kh);
    }
}

// From the pole, and from eight sides at six heights down to 4 degrees.
static vec3 from_direction(int i)
{
    const double theta = i ? (0.25 + (i - 1) / 8) * 0.265 : 0.0, phi = (i - 1) % 8 * (M_PI / 4.0);
    return vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

void ndf_albedo(struct ndf_albedo *out, const float *ndf)
{
    memset(out, 0, sizeof *out);
    for (int j = 0; j < NDF_SIDE; j++)
        for (int i = 0; i < NDF_SIDE; i++) {
            vec3 h;
            if (!ndf_direction(i, j, NDF_SIDE, &h))
                continue;
            const double solid = ndf_solid_angle((1.0 - h.z) / (1.0 + h.z), NDF_SIDE);
            for (int k = 0; k < NDF_FROM; k++)
                reflect(out, k, from_direction(k), h, solid, ndf + 3 * (j * NDF_SIDE + i));
        }
}

double ndf_reflects(const struct ndf_albedo *albedo, int channel, double r0)
{
    double most = 0.0;
    for (int k = 0; k < NDF_FROM; k++)
        most = fmax(most, r0 * albedo->from[k].all[channel] +
                              (1.0 - r0) * albedo->from[k].grazing[channel]);
    return most;
}

void ndf_limit(float *ndf, double r0, double most)
{
    struct ndf_albedo albedo;
    double share = 0.0;
    ndf_albedo(&albedo, ndf);
    for (int c = 0; c < 3; c++)
        share = fmax(share, ndf_reflects(&albedo, c, r0));
    for (int i = 0; i < NDF_VALUES && share > most; i++)
        ndf[i] *= (float)(most / share);
}

double ndf_most_r0(const struct ndf_albedo *albedo, double most)
{
    double r0 = 1.0;
    for (int k = 0; k < NDF_FROM; k++)
        for (int c = 0; c < 3; c++) {
            const double grazing = albedo->from[k].grazing[c];
            const double gain = albedo->from[k].all[c] - grazing;
            if (gain > 1e-12)
                r0 = fmin(r0, fmax(most - grazing, 0.0) / gain);
        }
    return r0;
}
