// dot_lanes.h - the sums of relighting for any set of WIDTH lanes; included by its file
//
// 64 pixels stay in registers over all planes, so that sums are never stored between planes. That
// many streams are more than the memory system follows by itself: each asks for what it reads 1 kB
// later. Every pixel sums in the same order with the same rounding, the last ones too.
#include "core/base/half.h"

#include <math.h>

enum { AT_ONCE = 64, AHEAD = 1024, LINE = 64 };

static inline float byte_value(const void *p)
{
    return *(const uint8_t *)p;
}

static inline float word_value(const void *p)
{
    return *(const uint16_t *)p;
}

static inline float half_value(const void *p)
{
    return float_from_half(*(const uint16_t *)p);
}

static inline float float_value(const void *p)
{
    return *(const float *)p;
}

// Samples of one kind: constants at each call, so that this becomes one tight loop for each.
struct samples {
    size_t size;
    lanes (*load)(const void *);
    float (*value)(const void *);
};

static inline __attribute__((always_inline)) void dot_run(float *out, size_t from, int rows,
                                                          float bias, const char *const *planes,
                                                          const float *w, int count,
                                                          struct samples s)
{
    lanes sum[AT_ONCE / WIDTH];
    for (int r = 0; r < rows; r++)
        sum[r] = lanes_all(bias);
    for (int k = 0; k < count; k++) {
        const char *p = planes[k] + from * s.size;
        const lanes weight = lanes_all(w[k]);
        for (size_t b = 0; b < (size_t)(rows * WIDTH) * s.size; b += LINE)
            __builtin_prefetch(p + AHEAD + b);
        for (int r = 0; r < rows; r++)
            sum[r] = lanes_madd(weight, s.load(p + (size_t)(r * WIDTH) * s.size), sum[r]);
    }
    for (int r = 0; r < rows; r++)
        lanes_store(out + from + r * WIDTH, sum[r]);
}

static inline __attribute__((always_inline)) void dot(float *out, size_t n, float bias,
                                                      const void *planes, const float *w, int count,
                                                      struct samples s)
{
    const char *const *p = planes;
    size_t i = 0;
    for (; i + AT_ONCE <= n; i += AT_ONCE)
        dot_run(out, i, AT_ONCE / WIDTH, bias, p, w, count, s);
    for (; i + WIDTH <= n; i += WIDTH)
        dot_run(out, i, 1, bias, p, w, count, s);
    for (; i < n; i++) {
        out[i] = bias;
        for (int k = 0; k < count; k++)
            out[i] = fmaf(w[k], s.value(p[k] + i * s.size), out[i]);
    }
}

static void dot_bytes(float *out, size_t n, float bias, const uint8_t *const *planes,
                      const float *weights, int count)
{
    dot(out, n, bias, planes, weights, count, (struct samples){1, load_bytes, byte_value});
}

static void dot_words(float *out, size_t n, float bias, const uint16_t *const *planes,
                      const float *weights, int count)
{
    dot(out, n, bias, planes, weights, count, (struct samples){2, load_words, word_value});
}

static void dot_halves(float *out, size_t n, float bias, const uint16_t *const *planes,
                       const float *weights, int count)
{
    dot(out, n, bias, planes, weights, count, (struct samples){2, load_halves, half_value});
}

static void dot_floats(float *out, size_t n, float bias, const float *const *planes,
                       const float *weights, int count)
{
    dot(out, n, bias, planes, weights, count, (struct samples){4, lanes_load, float_value});
}
