// test_nearest.c - the search kernels of every instruction set against double precision
#include "sets.h"

enum { MOST_DIM = 40, MOST_TILES = 9 };

static float points[MOST_DIM * BLOCK], codes[MOST_TILES * MOST_DIM * TILE], half[MOST_TILES * TILE];

static void fill(int dim, int tiles, float scale)
{
    uint32_t seed = (uint32_t)(dim * 100 + tiles);
    for (int i = 0; i < dim * BLOCK; i++)
        points[i] = scale * (float)(2.0 * test_uniform(&seed) - 1.0);
    for (int i = 0; i < tiles * dim * TILE; i++)
        codes[i] = scale * (float)(2.0 * test_uniform(&seed) - 1.0);
    for (int i = 0; i < tiles * TILE; i++)
        half[i] = scale * scale * (float)test_uniform(&seed);
    half[tiles * TILE - 1] = INFINITY;  // as behind the last code
}

static double score(int p, int t, int lane, int dim, double *bound)
{
    double sum = (double)half[t * TILE + lane];
    *bound = fabs(sum);
    for (int i = 0; i < dim; i++) {
        const double term =
            (double)points[i * BLOCK + p] * (double)codes[(t * dim + i) * TILE + lane];
        sum -= term;
        *bound += fabs(term);
    }
    return sum;
}

static void check_scan(const struct nearest_kernels *k, int dim, int tiles)
{
    float best[BLOCK], second[BLOCK];
    int32_t tile[BLOCK];
    k->scan(points, codes, half, tiles, dim, best, second, tile);
    for (int p = 0; p < BLOCK; p++) {
        double lowest = INFINITY, next = INFINITY, most = 0.0, own = INFINITY;
        for (int t = 0; t < tiles; t++) {
            double in_tile = INFINITY;
            for (int l = 0; l < TILE; l++) {
                double bound;
                const double s = score(p, t, l, dim, &bound);
                in_tile = fmin(in_tile, s);
                most = isfinite(bound) ? fmax(most, bound) : most;
            }
            own = t == tile[p] ? in_tile : own;
            next = fmin(next, fmax(lowest, in_tile));
            lowest = fmin(lowest, in_tile);
        }
        const double tolerance = 0x1p-24 * (dim + 1) * most;  // each sum rounds dim + 1 times
        CHECK_NEAR(best[p], lowest, tolerance);
        CHECK_NEAR(own, lowest, 2.0 * tolerance);
        if (tiles == 1)
            assert_true(isinf(second[p]) && second[p] > 0.0f);
        else
            CHECK_NEAR(second[p], next, tolerance);
    }
}

static void check_measure(const struct nearest_kernels *k, int dim)
{
    float vector[MOST_DIM];
    double got[TILE];
    for (int i = 0; i < dim; i++)
        vector[i] = points[i * BLOCK];
    k->measure(got, vector, codes, dim);
    for (int l = 0; l < TILE; l++) {
        double want = 0.0;
        for (int i = 0; i < dim; i++) {
            const double d = (double)vector[i] - (double)codes[i * TILE + l];
            want += d * d;
        }
        assert_true(got[l] == want);  // equal bits in every set
    }
}

static void test_sets(void **state)
{
    (void)state;
    static const float scales[] = {1.0f, 1e15f, 1e-15f};
    for (int s = 0; sets[s]; s++)
        for (int dim = 1; dim <= MOST_DIM; dim += dim < 9 ? 1 : 7)
            for (int tiles = 1; tiles <= MOST_TILES; tiles++)
                for (int i = 0; i < 3; i++) {
                    fill(dim, tiles, scales[i]);
                    check_scan(sets[s]->nearest, dim, tiles);
                    check_measure(sets[s]->nearest, dim);
                }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_sets)};
    return cmocka_run_group_tests(tests, find_sets, NULL);
}
