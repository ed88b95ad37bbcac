// kernels_c.c - plain C, the reference for every other set
#include "relight/kernels.h"

#include "image/half.h"

static void fill(float *out, size_t n, float bias)
{
    for (size_t i = 0; i < n; i++)
        out[i] = bias;
}

static void dot_bytes(float *out, size_t n, float bias, const uint8_t *const *planes,
                      const float *weights, int count)
{
    fill(out, n, bias);
    for (int k = 0; k < count; k++)
        for (size_t i = 0; i < n; i++)
            out[i] += weights[k] * (float)planes[k][i];
}

static void dot_words(float *out, size_t n, float bias, const uint16_t *const *planes,
                      const float *weights, int count)
{
    fill(out, n, bias);
    for (int k = 0; k < count; k++)
        for (size_t i = 0; i < n; i++)
            out[i] += weights[k] * (float)planes[k][i];
}

static void dot_halves(float *out, size_t n, float bias, const uint16_t *const *planes,
                       const float *weights, int count)
{
    fill(out, n, bias);
    for (int k = 0; k < count; k++)
        for (size_t i = 0; i < n; i++)
            out[i] += weights[k] * float_from_half(planes[k][i]);
}

static void dot_floats(float *out, size_t n, float bias, const float *const *planes,
                       const float *weights, int count)
{
    fill(out, n, bias);
    for (int k = 0; k < count; k++)
        for (size_t i = 0; i < n; i++)
            out[i] += weights[k] * planes[k][i];
}

static void look_up(uint32_t *out, size_t n, const uint16_t *index, const uint32_t *table)
{
    for (size_t i = 0; i < n; i++)
        out[i] = table[index[i]];
}

const struct kernels kernels_c = {"c", dot_bytes, dot_words, dot_halves, dot_floats, look_up};

const struct kernels *kernels_choose(unsigned cpu_off)
{
    const unsigned features = relume_cpu_features() & ~cpu_off;
    return features & RELUME_CPU_AVX2 ? &kernels_avx2 : &kernels_c;
}
