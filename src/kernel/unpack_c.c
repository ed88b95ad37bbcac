// unpack_c.c - plain C, the reference for every other set
#include "kernel/kernels.h"

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

const struct unpack_kernels unpack_c = {thirds, codes};
