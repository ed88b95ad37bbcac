// dot_c.c - relighting in plain C, the reference for every other set
#include "core/kernel/kernels.h"

#include "core/base/half.h"

static void fill(float *out, size_t n, float bias)
{
    for (size_t i = 0; i < n; i++)
        out[i] = bias;
}

static void bytes(float *out, size_t n, float bias, const uint8_t *const *planes,
                  const float *weights, int count)
{
    fill(out, n, bias);
    for (int k = 0; k < count; k++)
        for (size_t i = 0; i < n; i++)
            out[i] += weights[k] * (float)planes[k][i];
}

static void words(float *out, size_t n, float bias, const uint16_t *const *planes,
                  const float *weights, int count)
{
    fill(out, n, bias);
    for (int k = 0; k < count; k++)
        for (size_t i = 0; i < n; i++)
            out[i] += weights[k] * (float)planes[k][i];
}

static void halves(float *out, size_t n, float bias, const uint16_t *const *planes,
                   const float *weights, int count)
{
    fill(out, n, bias);
    for (int k = 0; k < count; k++)
        for (size_t i = 0; i < n; i++)
            out[i] += weights[k] * float_from_half(planes[k][i]);
}

static void floats(float *out, size_t n, float bias, const float *const *planes,
                   const float *weights, int count)
{
    fill(out, n, bias);
    for (int k = 0; k < count; k++)
        for (size_t i = 0; i < n; i++)
            out[i] += weights[k] * planes[k][i];
}

void look_up_c(uint32_t *out, size_t n, const uint16_t *index, const uint32_t *table)
{
    for (size_t i = 0; i < n; i++)
        out[i] = table[index[i]];
}

const struct dot_kernels dot_c = {bytes, words, halves, floats};
