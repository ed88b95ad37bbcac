// nearest_c.c - the nearest code in plain C, the reference for every other set
#include "core/kernel/kernels.h"

#include <math.h>

static void score(float *out, const float *point, const float *tile, const float *half, int dim)
{
    for (int l = 0; l < TILE; l++)
        out[l] = half[l];
    for (int i = 0; i < dim; i++)
        for (int l = 0; l < TILE; l++)
            out[l] -= point[i * BLOCK] * tile[i * TILE + l];
}

static void scan(const float *points, const float *codes, const float *half, int tiles, int dim,
                 float best[BLOCK], float second[BLOCK], int32_t tile[BLOCK])
{
    for (int p = 0; p < BLOCK; p++) {
        best[p] = second[p] = INFINITY;
        tile[p] = 0;
        for (int t = 0; t < tiles; t++) {
            float s[TILE];
            score(s, points + p, codes + (size_t)t * (size_t)dim * TILE, half + t * TILE, dim);
            float lowest = s[0];
            for (int l = 1; l < TILE; l++)
                lowest = s[l] < lowest ? s[l] : lowest;
            if (lowest < best[p]) {
                second[p] = best[p];
                best[p] = lowest;
                tile[p] = t;
            } else if (lowest < second[p]) {
                second[p] = lowest;
            }
        }
    }
}

static void measure(double distance[TILE], const float *point, const float *tile, int dim)
{
    double sum[TILE] = {0.0};
    for (int i = 0; i < dim; i++)
        for (int l = 0; l < TILE; l++) {
            const double d = (double)point[i] - (double)tile[i * TILE + l];
            sum[l] += d * d;
        }
    for (int l = 0; l < TILE; l++)
        distance[l] = sum[l];
}

const struct nearest_kernels nearest_c = {scan, measure};
