// unpack_c.c - plain C, the reference for every other set
#include "core/kernel/kernels.h"

static void thirds(const uint8_t *in, size_t n, float *r, float *g, float *b)
{
    for (size_t i = 0; i < n; i++, in += 3) {
        r[i] = (float)in[0] / 255.0f;
        g[i] = (float)in[1] / 255.0f;
        b[i] = (float)in[2] / 255.0f;
    }
}

static void codes(const uint16_t *in, size_t n, float a, float b, uint8_t *out)
{
    for (size_t i = 0; i < n; i++) {
        const float v = (float)in[i] * a + b;
        out[i] = (uint8_t)(int)(v > 0.0f ? v < 255.0f ? v : 255.0f : 0.0f);
    }
}

void words_c(const float *in, size_t n, float least, float scale, uint16_t *out)
{
    for (size_t i = 0; i < n; i++) {
        const float v = (in[i] - least) * scale + 0.5f;
        out[i] = (uint16_t)(int)(v > 0.0f ? v : 0.0f);
    }
}

void range_c(const float *in, size_t n, float *min, float *max)
{
    for (size_t i = 0; i < n; i++) {
        *min = in[i] < *min ? in[i] : *min;
        *max = in[i] > *max ? in[i] : *max;
    }
}

const struct unpack_kernels unpack_c = {thirds, codes, words_c, range_c};
