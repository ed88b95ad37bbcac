// unpack_avx2.c - AVX2: eight pixels at a time, picked out of two loads that overlap
#include "core/kernel/kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

// Where the bytes of a channel lie among bytes 0 to 15, and 8 to 23, of eight pixels.
#define NONE (-1)
static const int8_t low_of[3][16] = {
    {0, 3, 6, 9, 12, 15, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE},
    {1, 4, 7, 10, 13, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE},
    {2, 5, 8, 11, 14, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE}};
static const int8_t high_of[3][16] = {
    {NONE, NONE, NONE, NONE, NONE, NONE, 10, 13, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE},
    {NONE, NONE, NONE, NONE, NONE, 8, 11, 14, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE},
    {NONE, NONE, NONE, NONE, NONE, 9, 12, 15, NONE, NONE, NONE, NONE, NONE, NONE, NONE, NONE}};

static inline __m256 third(__m128i low, __m128i high, int c)
{
    const __m128i a = _mm_shuffle_epi8(low, _mm_loadu_si128((const __m128i *)low_of[c]));
    const __m128i b = _mm_shuffle_epi8(high, _mm_loadu_si128((const __m128i *)high_of[c]));
    const __m256 v = _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_or_si128(a, b)));
    // a product, and what it misses of the quotient: rounded as the quotient for all 256 bytes
    const __m256 part = _mm256_set1_ps(1.0f / 255.0f), q = _mm256_mul_ps(v, part);
    return _mm256_fmadd_ps(_mm256_fnmadd_ps(q, _mm256_set1_ps(255.0f), v), part, q);
}

static void thirds(const uint8_t *in, size_t n, float *r, float *g, float *b)
{
    size_t i = 0;
    for (; i + 8 <= n; i += 8, in += 24) {
        const __m128i low = _mm_loadu_si128((const __m128i *)in);
        const __m128i high = _mm_loadu_si128((const __m128i *)(in + 8));
        _mm256_storeu_ps(r + i, third(low, high, 0));
        _mm256_storeu_ps(g + i, third(low, high, 1));
        _mm256_storeu_ps(b + i, third(low, high, 2));
    }
    unpack_c.thirds(in, n - i, r + i, g + i, b + i);
}

static inline __m256i eight(const uint16_t *in, __m256 a, __m256 b)
{
    const __m256i words = _mm256_cvtepu16_epi32(_mm_loadu_si128((const __m128i *)in));
    const __m256 v = _mm256_add_ps(_mm256_mul_ps(_mm256_cvtepi32_ps(words), a), b);
    const __m256 top = _mm256_set1_ps(255.0f);
    return _mm256_cvttps_epi32(_mm256_min_ps(_mm256_max_ps(v, _mm256_setzero_ps()), top));
}

static void codes(const uint16_t *in, size_t n, float a, float b, uint8_t *out)
{
    const __m256 av = _mm256_set1_ps(a), bv = _mm256_set1_ps(b);
    // packing works within halves of 128 bits: four runs of eight end up in this order
    const __m256i order = _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7);
    size_t i = 0;
    for (; i + 32 <= n; i += 32) {
        const __m256i p = _mm256_packus_epi32(eight(in + i, av, bv), eight(in + i + 8, av, bv));
        const __m256i q =
            _mm256_packus_epi32(eight(in + i + 16, av, bv), eight(in + i + 24, av, bv));
        const __m256i bytes = _mm256_permutevar8x32_epi32(_mm256_packus_epi16(p, q), order);
        _mm256_storeu_si256((__m256i *)(out + i), bytes);
    }
    unpack_c.codes(in + i, n - i, a, b, out + i);
}

static inline __m256i eight_words(const float *in, __m256 least, __m256 scale)
{
    const __m256 v = _mm256_mul_ps(_mm256_sub_ps(_mm256_loadu_ps(in), least), scale);
    const __m256 code = _mm256_add_ps(v, _mm256_set1_ps(0.5f));
    return _mm256_cvttps_epi32(_mm256_max_ps(code, _mm256_setzero_ps()));
}

static void words(const float *in, size_t n, float least, float scale, uint16_t *out)
{
    const __m256 min = _mm256_set1_ps(least), by = _mm256_set1_ps(scale);
    size_t i = 0;
    for (; i + 16 <= n; i += 16) {
        const __m256i both =
            _mm256_packus_epi32(eight_words(in + i, min, by), eight_words(in + i + 8, min, by));
        _mm256_storeu_si256((__m256i *)(out + i), _mm256_permute4x64_epi64(both, 0xd8));
    }
    words_c(in + i, n - i, least, scale, out + i);
}

static void range(const float *in, size_t n, float *min, float *max)
{
    float low[16], high[16];
    __m256 a = _mm256_set1_ps(*min), b = a, c = _mm256_set1_ps(*max), d = c;
    size_t i = 0;
    for (; i + 16 <= n; i += 16) {
        const __m256 v = _mm256_loadu_ps(in + i), w = _mm256_loadu_ps(in + i + 8);
        a = _mm256_min_ps(v, a);
        b = _mm256_min_ps(w, b);
        c = _mm256_max_ps(v, c);
        d = _mm256_max_ps(w, d);
    }
    _mm256_storeu_ps(low, a);
    _mm256_storeu_ps(low + 8, b);
    _mm256_storeu_ps(high, c);
    _mm256_storeu_ps(high + 8, d);
    for (int k = 0; k < 16; k++) {
        *min = low[k] < *min ? low[k] : *min;
        *max = high[k] > *max ? high[k] : *max;
    }
    range_c(in + i, n - i, min, max);
}

const struct unpack_kernels unpack_avx2 = {thirds, codes, words, range};
#endif
