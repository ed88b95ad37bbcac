// kernels_avx2.c - AVX2, FMA and F16C: eight lanes
#include "core/kernel/kernels.h"

#if defined(__x86_64__)
#include <immintrin.h>

enum { WIDTH = 8 };
typedef __m256 lanes;
typedef __m256i whole;

static inline lanes lanes_all(float v)
{
    return _mm256_set1_ps(v);
}

static inline lanes lanes_load(const void *p)
{
    return _mm256_loadu_ps(p);
}

static inline void lanes_store(float *p, lanes v)
{
    _mm256_storeu_ps(p, v);
}

// a b + c
static inline lanes lanes_madd(lanes a, lanes b, lanes c)
{
    return _mm256_fmadd_ps(a, b, c);
}

// c - a b
static inline lanes lanes_minus(lanes c, lanes a, lanes b)
{
    return _mm256_fnmadd_ps(a, b, c);
}

static inline lanes lanes_min(lanes a, lanes b)
{
    return _mm256_min_ps(a, b);
}

static inline lanes lanes_max(lanes a, lanes b)
{
    return _mm256_max_ps(a, b);
}

static inline whole whole_all(int v)
{
    return _mm256_set1_epi32(v);
}

static inline void whole_store(int32_t *p, whole v)
{
    _mm256_storeu_si256((__m256i *)p, v);
}

// x < y ? a : b
static inline whole whole_where_lower(lanes x, lanes y, whole a, whole b)
{
    return _mm256_blendv_epi8(b, a, _mm256_castps_si256(_mm256_cmp_ps(x, y, _CMP_LT_OQ)));
}

static inline lanes load_bytes(const void *p)
{
    return _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64(p)));
}

static inline lanes load_words(const void *p)
{
    return _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(_mm_loadu_si128(p)));
}

static inline lanes load_halves(const void *p)
{
    return _mm256_cvtph_ps(_mm_loadu_si128(p));
}

// Element index[i] in [0, 16) of two registers.
static inline lanes pick(lanes low, lanes high, whole index)
{
    const lanes a = _mm256_permutevar8x32_ps(low, index);
    const lanes b = _mm256_permutevar8x32_ps(high, index);
    return _mm256_blendv_ps(a, b, _mm256_castsi256_ps(_mm256_slli_epi32(index, 28)));
}

// The line at `first` + i `scale`: at scales up to 1.6 within 16 texels, which two loads and
// permutations fetch faster than a gather.
static inline lanes lanes_look_up(const float *line, float first, float scale)
{
    const lanes number = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
    const lanes x = lanes_madd(lanes_all(scale), number, lanes_all(first));
    const whole j = _mm256_cvttps_epi32(x);
    const lanes t = x - _mm256_cvtepi32_ps(j);
    const lanes low = lanes_load(line), high = lanes_load(line + WIDTH);
    const lanes a = pick(low, high, j);
    const lanes b = pick(low, high, _mm256_add_epi32(j, whole_all(1)));
    return lanes_madd(t, b - a, a);
}

#include "core/kernel/dot_lanes.h"
#include "core/kernel/nearest_lanes.h"
#include "core/kernel/psf_lanes.h"

// Eight plain loads are faster than a gather, and stores past the cache save reading what is
// overwritten.
void look_up_avx2(uint32_t *out, size_t n, const uint16_t *index, const uint32_t *table)
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

// Each lane adds its own terms in order, with a rounded product: no FMA here.
void measure_avx2(double distance[TILE], const float *point, const float *tile, int dim)
{
    __m256d sum = _mm256_setzero_pd();
    for (int i = 0; i < dim; i++) {
        const __m256d x = _mm256_set1_pd((double)point[i]);
        const __m256d d = _mm256_sub_pd(x, _mm256_cvtps_pd(_mm_loadu_ps(tile + i * TILE)));
        sum = _mm256_add_pd(sum, _mm256_mul_pd(d, d));
    }
    _mm256_storeu_pd(distance, sum);
}

const struct dot_kernels dot_avx2 = {dot_bytes, dot_words, dot_halves, dot_floats};
const struct nearest_kernels nearest_avx2 = {scan, measure_avx2};
const struct psf_kernels psf_avx2 = {mix, spread, spread_one};
#endif
