// kernels.h - the inner loops of relighting, one struct of functions per instruction set
#ifndef RELIGHT_KERNELS_H
#define RELIGHT_KERNELS_H

#include <relume/base.h>

// out[i] = bias + sum_k weights[k] * planes[k][i] for i in [0, n)
struct kernels {
    const char *name;
    void (*dot_bytes)(float *out, size_t n, float bias, const uint8_t *const *planes,
                      const float *weights, int count);
    void (*dot_words)(float *out, size_t n, float bias, const uint16_t *const *planes,
                      const float *weights, int count);
    void (*dot_halves)(float *out, size_t n, float bias, const uint16_t *const *planes,
                       const float *weights, int count);
    void (*dot_floats)(float *out, size_t n, float bias, const float *const *planes,
                       const float *weights, int count);
    // out[i] = table[index[i]]
    void (*look_up)(uint32_t *out, size_t n, const uint16_t *index, const uint32_t *table);
};
extern const struct kernels kernels_c;     // the reference
extern const struct kernels kernels_avx2;  // AVX2, FMA, F16C

// The fastest that this CPU runs without the features `cpu_off`.
const struct kernels *kernels_choose(unsigned cpu_off);

#endif
