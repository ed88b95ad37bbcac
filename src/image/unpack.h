// unpack.h - pixels of bytes become planes of floats, one struct per instruction set
#ifndef IMAGE_UNPACK_H
#define IMAGE_UNPACK_H

#include <relume/base.h>

struct unpack_kernels {
    const char *name;
    // r[i] = in[3 i] / 255 and so on for i in [0, n), rounded once: equal bits in every set.
    void (*thirds)(const uint8_t *in, size_t n, float *r, float *g, float *b);
    // out[i] = in[i] * a + b cut off at 0 and 255, towards zero: equal bits in every set.
    void (*codes)(const uint16_t *in, size_t n, float a, float b, uint8_t *out);
};
extern const struct unpack_kernels unpack_kernels_c;     // the reference
extern const struct unpack_kernels unpack_kernels_avx2;  // AVX2

// The fastest that this CPU runs without the features `cpu_off`.
const struct unpack_kernels *unpack_choose(unsigned cpu_off);

#endif
