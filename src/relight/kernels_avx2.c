// kernels_avx2.c - AVX2, FMA and F16C: 8 pixels a step, 4 planes a sweep, so that the memory system
// sees 4 streams and sums stay in the first-level cache
#include "relight/kernels.h"

#if defined(__AVX2__) && defined(__FMA__) && defined(__F16C__)
#include <immintrin.h>
#include <math.h>

static inline __m256 load_bytes(const void *p)
{
    return _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64(p)));
}

static inline __m256 load_words(const void *p)
{
    return _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(_mm_loadu_si128(p)));
}

static inline __m256 load_halves(const void *p)
{
    return _mm256_cvtph_ps(_mm_loadu_si128(p));
}

static inline __m256 load_floats(const void *p)
{
    return _mm256_loadu_ps(p);
}

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
    return _cvtsh_ss(*(const uint16_t *)p);
}

static inline float float_value(const void *p)
{
    return *(const float *)p;
}

// One sweep over up to 4 planes. `load`, `value` and `size` are constants at each call, so that
// this becomes one tight loop per sample type. Head and tail sum in the same order with the same
// rounding: a pixel's bits do not depend on where a tile begins.
static inline __attribute__((always_inline)) void sweep(float *out, size_t n,
                                                        const char *const *planes, const float *w,
                                                        int count, size_t size,
                                                        __m256 (*load)(const void *),
                                                        float (*value)(const void *))
{
    __m256 weight[4];
    for (int k = 0; k < count; k++)
        weight[k] = _mm256_set1_ps(w[k]);
    size_t i = 0;
    for (; i + 8 <= n; i += 8) {
        __m256 sum = _mm256_loadu_ps(out + i);
        for (int k = 0; k < count; k++)
            sum = _mm256_fmadd_ps(weight[k], load(planes[k] + i * size), sum);
        _mm256_storeu_ps(out + i, sum);
    }
    for (; i < n; i++)
        for (int k = 0; k < count; k++)
            out[i] = fmaf(w[k], value(planes[k] + i * size), out[i]);
}

static inline __attribute__((always_inline)) void dot(float *out, size_t n, float bias,
                                                      const void *planes, const float *w, int count,
                                                      size_t size, __m256 (*load)(const void *),
                                                      float (*value)(const void *))
{
    const char *const *p = planes;
    for (size_t i = 0; i < n; i++)
        out[i] = bias;
    int k = 0;
    for (; k + 4 <= count; k += 4)
        sweep(out, n, p + k, w + k, 4, size, load, value);
    for (; k < count; k++)
        sweep(out, n, p + k, w + k, 1, size, load, value);
}

static void dot_bytes(float *out, size_t n, float bias, const uint8_t *const *planes,
                      const float *weights, int count)
{
    dot(out, n, bias, planes, weights, count, 1, load_bytes, byte_value);
}

static void dot_words(float *out, size_t n, float bias, const uint16_t *const *planes,
                      const float *weights, int count)
{
    dot(out, n, bias, planes, weights, count, 2, load_words, word_value);
}

static void dot_halves(float *out, size_t n, float bias, const uint16_t *const *planes,
                       const float *weights, int count)
{
    dot(out, n, bias, planes, weights, count, 2, load_halves, half_value);
}

static void dot_floats(float *out, size_t n, float bias, const float *const *planes,
                       const float *weights, int count)
{
    dot(out, n, bias, planes, weights, count, 4, load_floats, float_value);
}

// Eight plain loads are faster than a gather, and stores past the cache save reading what is
// overwritten.
static void look_up(uint32_t *out, size_t n, const uint16_t *index, const uint32_t *table)
{
    size_t i = 0;
    for (; i < n && (uintptr_t)(out + i) % 32; i++)
        out[i] = table[index[i]];
    for (; i + 8 <= n; i += 8) {
        const uint16_t *at = index + i;
        const __m256i pixels = _mm256_setr_epi32(
            (int)table[at[0]], (int)table[at[1]], (int)table[at[2]], (int)table[at[3]],
            (int)table[at[4]], (int)table[at[5]], (int)table[at[6]], (int)table[at[7]]);
        _mm256_stream_si256((__m256i *)(out + i), pixels);
    }
    _mm_sfence();
    for (; i < n; i++)
        out[i] = table[index[i]];
}

const struct kernels kernels_avx2 = {"avx2", dot_bytes, dot_words, dot_halves, dot_floats, look_up};
#else
const struct kernels kernels_avx2;  // never chosen: relume_cpu_features has no such bit here
#endif
