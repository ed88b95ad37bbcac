// kernels_avx2.c - AVX2 and FMA: 8 lookups a step; at scales up to 1.6 they lie within 16 texels,
// which two loads and permutations fetch faster than a gather
#include "post/psf.h"

#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>

static void mix(float *out, const float *a, const float *b, float t, int n)
{
    const __m256 weight = _mm256_set1_ps(t);
    int i = 0;
    for (; i + 8 <= n; i += 8) {
        const __m256 x = _mm256_loadu_ps(a + i), y = _mm256_loadu_ps(b + i);
        _mm256_storeu_ps(out + i, _mm256_fmadd_ps(weight, _mm256_sub_ps(y, x), x));
    }
    for (; i < n; i++)
        out[i] = __builtin_fmaf(t, b[i] - a[i], a[i]);
}

// Element index[i] in [0, 16) of two registers.
static inline __m256 pick(__m256 low, __m256 high, __m256i index)
{
    const __m256 a = _mm256_permutevar8x32_ps(low, index);
    const __m256 b = _mm256_permutevar8x32_ps(high, index);
    const __m256 upper = _mm256_castsi256_ps(_mm256_slli_epi32(index, 28));
    return _mm256_blendv_ps(a, b, upper);
}

static inline __m256 lookup(const float *line, float at, float scale, int i)
{
    const __m256 number = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
    const float first = __builtin_fmaf(scale, (float)i, at);
    const int base = (int)first;
    const __m256 x =
        _mm256_fmadd_ps(_mm256_set1_ps(scale), number, _mm256_set1_ps(first - (float)base));
    const __m256i j = _mm256_cvttps_epi32(x);
    const __m256 t = _mm256_sub_ps(x, _mm256_cvtepi32_ps(j));
    const __m256 low = _mm256_loadu_ps(line + base), high = _mm256_loadu_ps(line + base + 8);
    const __m256 a = pick(low, high, j);
    const __m256 b = pick(low, high, _mm256_add_epi32(j, _mm256_set1_epi32(1)));
    return _mm256_fmadd_ps(t, _mm256_sub_ps(b, a), a);
}

static inline float lookup_one(const float *line, float at, float scale, int i)
{
    const float x = __builtin_fmaf(scale, (float)i, at);
    const int j = (int)x;
    return __builtin_fmaf(x - (float)j, line[j + 1] - line[j], line[j]);
}

static void spread(float *const out[3], int n, const float *line, float at, float scale,
                   const float rgb[3])
{
    const __m256 r = _mm256_set1_ps(rgb[0]), g = _mm256_set1_ps(rgb[1]), b = _mm256_set1_ps(rgb[2]);
    int i = 0;
    for (; i + 8 <= n; i += 8) {
        const __m256 v = lookup(line, at, scale, i);
        _mm256_storeu_ps(out[0] + i, _mm256_fmadd_ps(r, v, _mm256_loadu_ps(out[0] + i)));
        _mm256_storeu_ps(out[1] + i, _mm256_fmadd_ps(g, v, _mm256_loadu_ps(out[1] + i)));
        _mm256_storeu_ps(out[2] + i, _mm256_fmadd_ps(b, v, _mm256_loadu_ps(out[2] + i)));
    }
    for (; i < n; i++)
        for (int c = 0; c < 3; c++)
            out[c][i] = __builtin_fmaf(rgb[c], lookup_one(line, at, scale, i), out[c][i]);
}

static void spread_one(float *out, int n, const float *line, float at, float scale, float weight)
{
    const __m256 w = _mm256_set1_ps(weight);
    int i = 0;
    for (; i + 8 <= n; i += 8)
        _mm256_storeu_ps(out + i,
                         _mm256_fmadd_ps(w, lookup(line, at, scale, i), _mm256_loadu_ps(out + i)));
    for (; i < n; i++)
        out[i] = __builtin_fmaf(weight, lookup_one(line, at, scale, i), out[i]);
}

const struct psf_kernels psf_kernels_avx2 = {"avx2", mix, spread, spread_one};
#else
const struct psf_kernels psf_kernels_avx2 = {"avx2", NULL, NULL, NULL};
#endif
