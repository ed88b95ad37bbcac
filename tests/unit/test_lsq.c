// test_lsq.c - tests of src/core/math/lsq.h: small dense linear algebra, by Eigen (lsq_eigen.cpp)
#include "test.h"

#include "core/math/lsq.h"
#include "core/kernel/kernels.h"
#include "core/kernel/lsq_kernels.h"

enum { N = 24 };

// Symmetric, with eigenvalues that a sum of random products has.
static void fill(double *a, int n, uint32_t seed)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++)
            a[i * n + j] = a[j * n + i] = 2.0 * test_uniform(&seed) - 1.0;
}

static double dot(const double *a, const double *b, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

// A v = lambda v, orthonormal, descending, largest component positive, and no larger eigenvalue is
// left out: the trace is the sum of all.
static void test_eigenvectors(void **state)
{
    (void)state;
    const int counts[] = {1, 5, N};
    for (int round = 0; round < 3; round++) {
        const int k = counts[round];
        double a[N * N], work[N * N], values[N], v[N * N], all[N], trace = 0.0, total = 0.0;
        fill(a, N, 5 + (uint32_t)round);
        memcpy(work, a, sizeof a);
        assert_true(lsq_eigenvectors(work, N, k, values, v));
        memcpy(work, a, sizeof a);
        assert_true(lsq_eigenvalues(work, N, all));
        for (int i = 0; i < N; i++) {
            trace += a[i * N + i];
            total += all[i];
        }
        CHECK_NEAR(total, trace, 1e-12);
        for (int i = 0; i < k; i++) {
            CHECK_NEAR(values[i], all[N - 1 - i], 1e-12);
            double top = 0.0;
            for (int j = 0; j < N; j++) {
                CHECK_NEAR(dot(a + j * N, v + i * N, N), values[i] * v[i * N + j], 1e-12);
                top = fabs(v[i * N + j]) > fabs(top) ? v[i * N + j] : top;
            }
            assert_true(top > 0.0);
            for (int j = 0; j <= i; j++)
                CHECK_NEAR(dot(v + i * N, v + j * N, N), i == j, 1e-12);
        }
    }
}

// Equal eigenvalues and zero matrices leave the vectors open, but not their being orthonormal.
static void test_degenerate_eigenvectors(void **state)
{
    (void)state;
    for (int round = 0; round < 2; round++) {
        double a[N * N] = {0}, values[N], v[N * N];
        for (int i = 0; i < N; i++)
            a[i * N + i] = round;
        assert_true(lsq_eigenvectors(a, N, 7, values, v));
        for (int i = 0; i < 7; i++) {
            CHECK_NEAR(values[i], round, 1e-14);
            for (int j = 0; j <= i; j++)
                CHECK_NEAR(dot(v + i * N, v + j * N, N), i == j, 1e-12);
        }
    }
}

// The way for large matrices: eigenvalues that fall by half a decade each over a floor of 1e-6, in
// axes turned by a reflection I - 2 u u'; and a zero matrix.
static void test_large_eigenvectors(void **state)
{
    (void)state;
    enum { LARGE = 1100, K = 12 };
    const size_t n = LARGE;
    double *a = calloc(n * n, sizeof *a), *v = calloc(K * n, sizeof *v), values[K];
    double *u = calloc(n, sizeof *u), length = 0.0;
    assert_true(lsq_eigenvectors(a, LARGE, K, values, v));
    for (int i = 0; i < K; i++) {
        CHECK_NEAR(values[i], 0.0, 1e-12);
        for (int j = 0; j <= i; j++)
            CHECK_NEAR(dot(v + (size_t)i * n, v + (size_t)j * n, LARGE), i == j, 1e-9);
    }
    uint32_t seed = 3;
    for (size_t i = 0; i < n; i++) {
        u[i] = test_uniform(&seed) - 0.5;
        length += u[i] * u[i];
    }
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            a[i * n + j] = i == j ? 1e-6 : 0.0;
            for (int k = 0; k < 2 * K; k++)  // sum of lambda q q', q a column of the reflection
                a[i * n + j] += pow(10.0, -0.5 * k) *
                                ((i == (size_t)k) - 2.0 * u[i] * u[k] / length) *
                                ((j == (size_t)k) - 2.0 * u[j] * u[k] / length);
        }
    assert_true(lsq_eigenvectors(a, LARGE, K, values, v));
    for (int i = 0; i < K; i++) {
        double along = 0.0;
        CHECK_NEAR(values[i], pow(10.0, -0.5 * i) + 1e-6, 1e-9);
        for (size_t j = 0; j < n; j++)
            along += v[(size_t)i * n + j] * ((j == (size_t)i) - 2.0 * u[j] * u[i] / length);
        CHECK_NEAR(fabs(along), 1.0, 1e-9);
    }
    free(a);
    free(v);
    free(u);
}

static void test_invert(void **state)
{
    (void)state;
    double a[N * N], inverse[N * N];
    fill(a, N, 3);
    for (int i = 0; i < N; i++)
        a[i * N + (i + 1) % N] += 4.0;  // not symmetric, and rows must be exchanged
    memcpy(inverse, a, sizeof a);
    CHECK_OK(lsq_invert(inverse, N));
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            double sum = 0.0;
            for (int k = 0; k < N; k++)
                sum += a[i * N + k] * inverse[k * N + j];
            CHECK_NEAR(sum, i == j, 1e-11);
        }
    double singular[4] = {1.0, 2.0, 2.0, 4.0};
    assert_int_equal(lsq_invert(singular, 2), RELUME_EUNFIT);
}

static void test_add_gram(void **state)
{
    (void)state;
    enum { ROWS = 7, D = 5 };
    uint32_t seed = 9;
    double rows[ROWS * D], gram[D * D];
    for (int i = 0; i < ROWS * D; i++)
        rows[i] = test_uniform(&seed);
    for (int i = 0; i < D * D; i++)
        gram[i] = 0.5 * (i / D + i % D);  // symmetric: what is there stays
    lsq_add_gram(gram, D, rows, ROWS);
    for (int i = 0; i < D; i++)
        for (int j = 0; j < D; j++) {
            double want = 0.5 * (i + j);
            for (int r = 0; r < ROWS; r++)
                want += rows[r * D + i] * rows[r * D + j];
            CHECK_NEAR(gram[i * D + j], want, 1e-14);
        }
}

static void test_cholesky(void **state)
{
    (void)state;
    double a[N * N] = {0}, rows[2 * N * N], factor[N * N], inverse[N * N];
    uint32_t seed = 21;
    for (int i = 0; i < 2 * N * N; i++)
        rows[i] = test_uniform(&seed) - 0.5;
    lsq_add_gram(a, N, rows, 2 * N);
    memcpy(factor, a, sizeof a);
    assert_true(lsq_cholesky(factor, N));
    memcpy(inverse, factor, sizeof factor);
    assert_true(lsq_invert_lower(inverse, N));
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            double square = 0.0, one = 0.0;
            for (int k = 0; k < N; k++) {
                square += factor[i * N + k] * factor[j * N + k];
                one += factor[i * N + k] * inverse[k * N + j];
            }
            CHECK_NEAR(square, a[i * N + j], 1e-12);
            CHECK_NEAR(one, i == j, 1e-10);
            if (j > i)
                assert_true(factor[i * N + j] == 0.0);
        }
    double indefinite[4] = {1.0, 2.0, 2.0, 1.0};
    assert_false(lsq_cholesky(indefinite, 2));
}

static void test_multiply(void **state)
{
    (void)state;
    enum { M = 3, K = 4, C = 5, LDA = 6, LDB = 7, LDC = 8 };
    float a[M * LDA], b[K * LDB], c[M * LDC];
    uint32_t seed = 2;
    for (int i = 0; i < M * LDA; i++)
        a[i] = (float)test_uniform(&seed);
    for (int i = 0; i < K * LDB; i++)
        b[i] = (float)test_uniform(&seed);
    for (int i = 0; i < M * LDC; i++)
        c[i] = -1.0f;
    lsq_multiply(M, C, K, a, LDA, b, LDB, c, LDC);
    for (int i = 0; i < M; i++)
        for (int j = 0; j < LDC; j++) {
            double want = j < C ? 0.0 : -1.0;  // what lies beyond the columns stays
            for (int k = 0; j < C && k < K; k++)
                want += (double)a[i * LDA + k] * (double)b[k * LDB + j];
            CHECK_NEAR((double)c[i * LDC + j], want, 1e-6);
        }
}

// Both tables, whole or turned, small and beyond a block, against sums in order.
static void check_products(const struct lsq_kernels *k)
{
    static const int sizes[][3] = {{1, 1, 1}, {5, 3, 4}, {27, 130, 49}, {70, 9, 300}};
    uint32_t seed = 9;
    for (int t = 0; t < 16; t++) {
        const int m = sizes[t / 4][0], n = sizes[t / 4][1], l = sizes[t / 4][2];
        const bool ta = t & 1, tb = t & 2;
        double *a = malloc((size_t)(m * l) * sizeof *a), *b = malloc((size_t)(l * n) * sizeof *b);
        double *c = malloc((size_t)(m * n) * sizeof *c);
        for (int i = 0; i < m * l; i++)
            a[i] = test_uniform(&seed) - 0.5;
        for (int i = 0; i < l * n; i++)
            b[i] = test_uniform(&seed) - 0.5;
        const struct lsq_shape s = {m, n, l, ta ? m : l, tb ? l : n, n, ta, tb};
        k->multiply_double(s, a, b, c);
        for (int i = 0; i < m; i++)
            for (int j = 0; j < n; j++) {
                double want = 0.0;
                for (int x = 0; x < l; x++)
                    want += a[ta ? x * m + i : i * l + x] * b[tb ? j * l + x : x * n + j];
                CHECK_NEAR(c[i * n + j], want, 1e-13);  // 300 products below 1/4, 2^-53 each
            }
        free(a);
        free(b);
        free(c);
    }
}

static void test_tables(void **state)
{
    (void)state;
    check_products(kernels_choose(~0u)->lsq);
    check_products(kernels_choose(RELUME_CPU_AVX512)->lsq);
    check_products(kernels_choose(0)->lsq);
}

// Bytes of a file are those of its numbers: not a bit may depend on where memory is.
enum { PLACES = 16, MOST_SIDE = 24, MOST_SIZE = MOST_SIDE * MOST_SIDE };

// A product that lies `place` numbers behind a whole vector, and its factors elsewhere behind one.
static void product_at(float *c_at_0, int m, int n, int k, int place)
{
    _Alignas(64) float a[MOST_SIZE + 2 * PLACES], b[MOST_SIZE + 2 * PLACES],
        c[MOST_SIZE + 2 * PLACES];
    uint32_t seed = 7;
    for (int i = 0; i < m * k; i++)
        a[3 * place % PLACES + i] = (float)test_uniform(&seed);
    for (int i = 0; i < k * n; i++)
        b[5 * place % PLACES + i] = (float)test_uniform(&seed);
    lsq_multiply(m, n, k, a + 3 * place % PLACES, k, b + 5 * place % PLACES, n, c + place, n);
    memcpy(c_at_0, c + place, (size_t)(m * n) * sizeof *c);
}

static void test_products_anywhere(void **state)
{
    (void)state;
    for (int t = 0; t < MOST_SIZE; t++) {
        const int m = t % 8 + 1, n = t / 8 % 8 + 1, k = t % 23 + 1;
        float first[64], other[64];
        product_at(first, m, n, k, 0);
        for (int place = 1; place < PLACES; place++) {
            product_at(other, m, n, k, place);
            assert_memory_equal(first, other, (size_t)(m * n) * sizeof *first);
        }
    }
}

static void solution_at(double *b_at_0, int n, int place)
{
    _Alignas(64) double a[MOST_SIZE + PLACES] = {0}, b[MOST_SIZE + PLACES] = {0};
    uint32_t seed = 7;
    for (int i = 0; i < n * n; i++) {
        a[place + i] = i % (n + 1) ? 0.0 : 1.0;
        b[place + i] = test_uniform(&seed) - 0.5;
    }
    lsq_add_gram(a + place, n, b + place, n);
    assert_true(lsq_solve(a + place, n, b + place, n));
    assert_true(lsq_invert_lower(a + place, n));
    CHECK_OK(lsq_invert(b + place, n));
    for (int i = 0; i < n * n; i++)
        b_at_0[i] = b[place + i] + (i / n >= i % n ? a[place + i] : 0.0);
}

static void test_solutions_anywhere(void **state)
{
    (void)state;
    for (int n = 1; n <= MOST_SIDE; n++)
        for (int place = 1; place < PLACES; place++) {
            double first[MOST_SIZE], other[MOST_SIZE];
            solution_at(first, n, 0);
            solution_at(other, n, place);
            assert_memory_equal(first, other, (size_t)(n * n) * sizeof *first);
        }
}

// RELUME_CPU=plain turns every kernel off.
static void test_plain_cpu(void **state)
{
    (void)state;
    const unsigned before = relume_cpu_features();
    setenv("RELUME_CPU", "plain", 1);
    assert_int_equal(relume_cpu_features(), 0);
    CHECK_OK(relume_cpu_check(NULL));
    setenv("RELUME_CPU", "sse9", 1);
    assert_int_equal(relume_cpu_features(), before);
    assert_int_equal(relume_cpu_check(NULL), RELUME_EINVAL);
    unsetenv("RELUME_CPU");
    assert_int_equal(relume_cpu_features(), before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_eigenvectors),       cmocka_unit_test(test_degenerate_eigenvectors),
        cmocka_unit_test(test_large_eigenvectors), cmocka_unit_test(test_invert),
        cmocka_unit_test(test_add_gram),           cmocka_unit_test(test_cholesky),
        cmocka_unit_test(test_multiply),           cmocka_unit_test(test_tables),
        cmocka_unit_test(test_plain_cpu),          cmocka_unit_test(test_products_anywhere),
        cmocka_unit_test(test_solutions_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
