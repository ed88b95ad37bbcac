// nearest.c - a fast search in single precision, decided in double where it could be wrong
//
// |x - c|^2 = |x|^2 + 2 s with the score s = |c|^2 / 2 - x . c, whose single precision sum of d
// products is off by at most u (d + 1) (|c|^2 / 2 + |x||c|), u = 2^-24 (Higham 2002, 3.1); moving
// both to a common centre first adds u (|x| + |c|)^2. Neither the nearest code nor the one found
// lies farther from the origin than |x| + D, D the distance found, so with M = |x|^2 + D^2 both
// errors stay below E = 3 u (d + 8) M. Every code whose score is within 2 E of the lowest could be
// the nearest; only these are measured in double precision. In the same way the second score bounds
// the distance of all other codes from below (Hamerly 2010): D2^2 >= |x|^2 + 2 s2 - 2 E2.
#include "format/codebook/nearest.h"

#include "core/base/memory.h"

#include <float.h>
#include <math.h>
#include <string.h>

relume_status nearest_create(struct nearest *out, int codes, int dim, unsigned cpu_off)
{
    const int tiles = (codes + TILE - 1) / TILE;
    const size_t lanes = (size_t)tiles * TILE;
    *out = (struct nearest){
        .kernels = kernels_choose(cpu_off)->nearest,
        .codes = codes,
        .dim = dim,
        .tiles = tiles,
        .center = mem_zeroed((size_t)dim, sizeof(float)),
        .packed = mem_zeroed(lanes * (size_t)dim, sizeof(float)),
        .exact = mem_zeroed(lanes * (size_t)dim, sizeof(float)),
        .half = mem_array(lanes, sizeof(float)),
    };
    if (out->center && out->packed && out->exact && out->half)
        return RELUME_OK;
    nearest_destroy(out);
    return RELUME_ENOMEM;
}

void nearest_destroy(struct nearest *n)
{
    mem_free(n->center);
    mem_free(n->packed);
    mem_free(n->exact);
    mem_free(n->half);
    *n = (struct nearest){0};
}

static void find_center(struct nearest *n, const float *codes)
{
    for (int i = 0; i < n->dim; i++) {
        double sum = 0.0;
        for (int c = 0; c < n->codes; c++)
            sum += (double)codes[(size_t)c * (size_t)n->dim + (size_t)i];
        n->center[i] = (float)(sum / n->codes);
    }
}

// A power of two, so that scaling rounds nothing; kept where single precision can hold squares.
static float find_scale(const struct nearest *n, const float *codes)
{
    float most = 0.0f;
    for (size_t i = 0; i < (size_t)n->codes * (size_t)n->dim; i++)
        most = fmaxf(most, fabsf(codes[i] - n->center[i % (size_t)n->dim]));
    int exponent = 0;
    if (most > 0.0f && isfinite(most))
        frexpf(most, &exponent);
    exponent = exponent > 120 ? 120 : exponent < -120 ? -120 : exponent;
    return ldexpf(1.0f, -exponent);
}

void nearest_set(struct nearest *n, const float *codes)
{
    const size_t dim = (size_t)n->dim;
    find_center(n, codes);
    n->scale = find_scale(n, codes);
    for (int c = 0; c < n->tiles * TILE; c++) {
        const size_t at = (size_t)(c / TILE) * dim * TILE + (size_t)(c % TILE);
        double square = 0.0;
        for (size_t i = 0; c < n->codes && i < dim; i++) {
            const float v = codes[(size_t)c * dim + i];
            const float moved = (v - n->center[i]) * n->scale;
            n->exact[at + i * TILE] = v;
            n->packed[at + i * TILE] = moved;
            square += (double)moved * (double)moved;
        }
        n->half[c] = c < n->codes ? (float)(0.5 * square) : INFINITY;
    }
}

struct found {
    double first, second;  // squared distances
    uint16_t code;
};

static void measure_tile(const struct nearest *n, const float *vector, int t, struct found *f)
{
    double d[TILE];
    n->kernels->measure(d, vector, n->exact + (size_t)t * (size_t)n->dim * TILE, n->dim);
    for (int l = 0; l < TILE && t * TILE + l < n->codes; l++)
        if (d[l] < f->first) {
            f->second = f->first;
            f->first = d[l];
            f->code = (uint16_t)(t * TILE + l);
        } else if (d[l] < f->second) {
            f->second = d[l];
        }
}

// Whether the tile holds a score of at most `limit`; true when something is not a number.
static bool is_candidate(const struct nearest *n, const float *point, int t, float limit)
{
    const float *tile = n->packed + (size_t)t * (size_t)n->dim * TILE;
    float score[TILE];
    memcpy(score, n->half + t * TILE, sizeof score);
    for (int i = 0; i < n->dim; i++)
        for (int l = 0; l < TILE; l++)
            score[l] -= point[i * BLOCK] * tile[i * TILE + l];
    bool beyond = true;
    for (int l = 0; l < TILE; l++)
        beyond &= score[l] > limit;
    return !beyond;
}

size_t nearest_scratch(const struct nearest *n)
{
    return (size_t)n->dim * BLOCK;
}

// What is known of a block after the scan.
struct block {
    float square[BLOCK], best[BLOCK], second[BLOCK];
    int32_t tile[BLOCK];
};

// Behind the last vector the first is repeated.
static void pack_block(const struct nearest *n, const float *vectors, const uint32_t *which,
                       size_t count, float *points, float square[BLOCK])
{
    const size_t dim = (size_t)n->dim;
    for (size_t p = 0; p < BLOCK; p++) {
        const float *v = vectors + (size_t)which[p < count ? p : 0] * dim;
        for (size_t i = 0; i < dim; i++)
            points[i * BLOCK + p] = (v[i] - n->center[i]) * n->scale;
    }
    memset(square, 0, BLOCK * sizeof *square);
    for (size_t i = 0; i < dim; i++)
        for (size_t p = 0; p < BLOCK; p++)
            square[p] += points[i * BLOCK + p] * points[i * BLOCK + p];
}

// 2 E for a code of score `score`.
static inline float window(const struct nearest *n, float square, float score)
{
    const float d2 = square + 2.0f * score;
    return 0x1p-24f * 6.0f * (float)(n->dim + 8) * (square + (d2 > 0.0f ? d2 : 0.0f)) + FLT_MIN;
}

// Below the distance to any code but the one found; 0 says nothing.
static float distance_of_others(const struct nearest *n, const struct block *b, size_t p,
                                const struct found *f)
{
    const double square =
        (double)(b->square[p] + 2.0f * b->second[p] - window(n, b->square[p], b->second[p]));
    const double other = square > 0.0 ? sqrt(square) / (double)n->scale : 0.0;
    const double same = sqrt(f->second);
    return (float)(0.999999 * fmin(fmin(same, other), (double)FLT_MAX));
}

static struct found decide(const struct nearest *n, const float *vector, const float *point,
                           float best, float range)
{
    struct found f = {INFINITY, INFINITY, 0};
    for (int t = 0; t < n->tiles; t++)
        if (is_candidate(n, point, t, best + range))
            measure_tile(n, vector, t, &f);
    return f;
}

void nearest_find(const struct nearest *n, const float *vectors, const uint32_t *which,
                  size_t count, uint16_t *index, double *distance, float *apart, float *scratch)
{
    struct block b;
    for (; count > 0; which += BLOCK, count -= count < BLOCK ? count : BLOCK) {
        pack_block(n, vectors, which, count, scratch, b.square);
        n->kernels->scan(scratch, n->packed, n->half, n->tiles, n->dim, b.best, b.second, b.tile);
        for (size_t p = 0; p < BLOCK && p < count; p++) {
            const size_t i = which[p];
            const float *vector = vectors + i * (size_t)n->dim;
            const float range = window(n, b.square[p], b.best[p]);
            struct found f = {INFINITY, INFINITY, 0};
            const bool clear = b.second[p] - b.best[p] > range;
            if (clear)
                measure_tile(n, vector, b.tile[p], &f);
            else
                f = decide(n, vector, scratch + p, b.best[p], range);
            index[i] = f.code;
            distance[i] = f.first;
            apart[i] = clear ? distance_of_others(n, &b, p, &f) : 0.0f;
        }
    }
}
