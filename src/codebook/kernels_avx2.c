// kernels_avx2.c - AVX2 and FMA: three vectors of eight points against a tile of four codes are
// twelve running sums, which with three points and one code fill the sixteen registers
#include "codebook/kernels.h"

#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
#include <math.h>

enum { WIDE = 8, ROWS = BLOCK / WIDE };

// The lowest scores of eight points so far.
struct lowest {
    __m256 best, second;
    __m256i tile;
};

static inline void take(struct lowest *l, __m256 a, __m256 b, __m256 c, __m256 d, __m256i tile)
{
    const __m256 score = _mm256_min_ps(_mm256_min_ps(a, b), _mm256_min_ps(c, d));
    const __m256 lower = _mm256_cmp_ps(score, l->best, _CMP_LT_OQ);
    l->second = _mm256_min_ps(l->second, _mm256_max_ps(l->best, score));
    l->best = _mm256_min_ps(l->best, score);
    l->tile = _mm256_castps_si256(
        _mm256_blendv_ps(_mm256_castsi256_ps(l->tile), _mm256_castsi256_ps(tile), lower));
}

static void scan(const float *points, const float *codes, const float *half, int tiles, int dim,
                 float best[BLOCK], float second[BLOCK], int32_t tile[BLOCK])
{
    struct lowest low[ROWS];
    for (int r = 0; r < ROWS; r++)
        low[r] = (struct lowest){_mm256_set1_ps(INFINITY), _mm256_set1_ps(INFINITY),
                                 _mm256_setzero_si256()};
    for (int t = 0; t < tiles; t++, codes += dim * TILE, half += TILE) {
        const __m256 h0 = _mm256_set1_ps(half[0]), h1 = _mm256_set1_ps(half[1]);
        const __m256 h2 = _mm256_set1_ps(half[2]), h3 = _mm256_set1_ps(half[3]);
        __m256 a0 = h0, a1 = h1, a2 = h2, a3 = h3;
        __m256 b0 = h0, b1 = h1, b2 = h2, b3 = h3;
        __m256 c0 = h0, c1 = h1, c2 = h2, c3 = h3;
        const float *x = points, *y = codes;
        for (int i = 0; i < dim; i++, x += BLOCK, y += TILE) {
            const __m256 xa = _mm256_loadu_ps(x), xb = _mm256_loadu_ps(x + WIDE);
            const __m256 xc = _mm256_loadu_ps(x + 2 * WIDE);
            __m256 code = _mm256_broadcast_ss(y);
            a0 = _mm256_fnmadd_ps(xa, code, a0);
            b0 = _mm256_fnmadd_ps(xb, code, b0);
            c0 = _mm256_fnmadd_ps(xc, code, c0);
            code = _mm256_broadcast_ss(y + 1);
            a1 = _mm256_fnmadd_ps(xa, code, a1);
            b1 = _mm256_fnmadd_ps(xb, code, b1);
            c1 = _mm256_fnmadd_ps(xc, code, c1);
            code = _mm256_broadcast_ss(y + 2);
            a2 = _mm256_fnmadd_ps(xa, code, a2);
            b2 = _mm256_fnmadd_ps(xb, code, b2);
            c2 = _mm256_fnmadd_ps(xc, code, c2);
            code = _mm256_broadcast_ss(y + 3);
            a3 = _mm256_fnmadd_ps(xa, code, a3);
            b3 = _mm256_fnmadd_ps(xb, code, b3);
            c3 = _mm256_fnmadd_ps(xc, code, c3);
        }
        const __m256i number = _mm256_set1_epi32(t);
        take(&low[0], a0, a1, a2, a3, number);
        take(&low[1], b0, b1, b2, b3, number);
        take(&low[2], c0, c1, c2, c3, number);
    }
    for (int r = 0; r < ROWS; r++) {
        _mm256_storeu_ps(best + r * WIDE, low[r].best);
        _mm256_storeu_ps(second + r * WIDE, low[r].second);
        _mm256_storeu_si256((__m256i *)(tile + r * WIDE), low[r].tile);
    }
}

// Each lane adds its own terms in order, with a rounded product: no FMA here.
static void measure(double distance[TILE], const float *point, const float *tile, int dim)
{
    __m256d sum = _mm256_setzero_pd();
    for (int i = 0; i < dim; i++) {
        const __m256d x = _mm256_set1_pd((double)point[i]);
        const __m256d d = _mm256_sub_pd(x, _mm256_cvtps_pd(_mm_loadu_ps(tile + i * TILE)));
        sum = _mm256_add_pd(sum, _mm256_mul_pd(d, d));
    }
    _mm256_storeu_pd(distance, sum);
}

const struct nearest_kernels nearest_kernels_avx2 = {"avx2", scan, measure};
#else
const struct nearest_kernels nearest_kernels_avx2;  // never chosen
#endif
