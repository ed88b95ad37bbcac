// psf_c.c - the chromatic sum's inner loops in plain C: the reference
#include "core/kernel/kernels.h"

static void mix(float *out, const float *a, const float *b, float t, int n)
{
    for (int i = 0; i < n; i++)
        out[i] = a[i] + t * (b[i] - a[i]);
}

static float lookup(const float *line, float at, float scale, int i)
{
    const float x = at + scale * (float)i;
    const int j = (int)x;
    return line[j] + (x - (float)j) * (line[j + 1] - line[j]);
}

static void spread(float *const out[3], int n, const float *line, float at, float scale,
                   const float rgb[3])
{
    for (int i = 0; i < n; i++) {
        const float v = lookup(line, at, scale, i);
        for (int c = 0; c < 3; c++)
            out[c][i] += rgb[c] * v;
    }
}

static void spread_one(float *out, int n, const float *line, float at, float scale, float weight)
{
    for (int i = 0; i < n; i++)
        out[i] += weight * lookup(line, at, scale, i);
}

const struct psf_kernels psf_c = {mix, spread, spread_one};
