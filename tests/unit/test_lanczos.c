// Lanczos's method against Jacobi rotations in double precision
#include "test.h"

#include "core/math/lanczos.h"

#include <math.h>
#include <string.h>

enum { N = 24 };

// a[N][N] becomes diagonal; rows of v are its eigenvectors. Slow and sure (Jacobi 1846).
static void jacobi(double *a, double *v)
{
    for (int i = 0; i < N * N; i++)
        v[i] = i / N == i % N;
    for (int sweep = 0; sweep < 40; sweep++)
        for (int p = 0; p < N; p++)
            for (int q = p + 1; q < N; q++) {
                const double angle = 0.5 * atan2(2.0 * a[p * N + q], a[q * N + q] - a[p * N + p]);
                const double c = cos(angle), s = sin(angle);
                for (int k = 0; k < N; k++) {
                    const double x = a[k * N + p], y = a[k * N + q];
                    a[k * N + p] = c * x - s * y;
                    a[k * N + q] = s * x + c * y;
                }
                for (int k = 0; k < N; k++) {
                    const double x = a[p * N + k], y = a[q * N + k];
                    const double u = v[p * N + k], w = v[q * N + k];
                    a[p * N + k] = c * x - s * y;
                    a[q * N + k] = s * x + c * y;
                    v[p * N + k] = c * u - s * w;
                    v[q * N + k] = s * u + c * w;
                }
            }
}

static void multiply(const void *context, const double *v, double *out)
{
    const double *a = context;
    for (int i = 0; i < N; i++) {
        out[i] = 0.0;
        for (int j = 0; j < N; j++)
            out[i] += a[i * N + j] * v[j];
    }
}

// G = R^T R of `rows` random rows, later ones weaker.
static void make(double *g, int rows, double decay)
{
    uint32_t seed = 5;
    memset(g, 0, N * N * sizeof *g);
    for (int r = 0; r < rows; r++) {
        double row[N];
        for (int i = 0; i < N; i++)
            row[i] = pow(decay, r) * (test_uniform(&seed) - 0.3);
        for (int i = 0; i < N * N; i++)
            g[i] += row[i / N] * row[i % N];
    }
}

// The diagonal, largest first.
static void sort_down(double *values, const double *a)
{
    for (int i = 0; i < N; i++) {
        int at = i;
        for (; at > 0 && values[at - 1] < a[i * N + i]; at--)
            values[at] = values[at - 1];
        values[at] = a[i * N + i];
    }
}

static void check(const double *g, int count, int steps, const double *start, double tolerance)
{
    double a[N * N], v[N * N], want[N], values[N], vectors[N * N], product[N];
    memcpy(a, g, sizeof a);
    jacobi(a, v);
    sort_down(want, a);
    CHECK_OK(lanczos_eigenvectors(N, count, steps, start, multiply, g, values, vectors));
    for (int k = 0; k < count; k++) {
        const double *q = vectors + k * N;
        double length = 0.0, most = 0.0;
        CHECK_NEAR(values[k], want[k], tolerance * want[0]);
        multiply(g, q, product);
        for (int i = 0; i < N; i++) {
            // the residual of a Ritz pair is the root of what the value misses
            CHECK_NEAR(product[i], values[k] * q[i], 10.0 * sqrt(tolerance) * want[0]);
            length += q[i] * q[i];
            most = fabs(q[i]) > fabs(most) ? q[i] : most;
        }
        CHECK_NEAR(length, 1.0, 1e-12);
        assert_true(most > 0.0);
    }
}

static void test_whole_space_is_exact(void **state)
{
    (void)state;
    double g[N * N], ones[N];
    for (int i = 0; i < N; i++)
        ones[i] = 1.0;
    make(g, 2 * N, 0.95);
    check(g, N, N, ones, 1e-13);
    check(g, 5, 1000, ones, 1e-13);  // no more than N are made
}

static void test_four_steps_each_are_enough(void **state)
{
    (void)state;
    double g[N * N], ones[N];
    for (int i = 0; i < N; i++)
        ones[i] = 1.0;
    make(g, 2 * N, 0.7);
    check(g, 4, 16, ones, 1e-11);
}

// Of rank 3, the space ends after three steps; from an eigenvector or from nothing after one. What
// lies in other directions is found all the same.
static void test_exhausted_spaces(void **state)
{
    (void)state;
    double g[N * N], start[N];
    for (int i = 0; i < N; i++)
        start[i] = 1.0 + i;
    make(g, 3, 0.8);
    check(g, 3, 12, start, 1e-13);
    check(g, 6, N, start, 1e-13);
    memset(start, 0, sizeof start);
    check(g, 3, N, start, 1e-13);
    memset(g, 0, sizeof g);
    for (int i = 0; i < N; i++)
        g[i * N + i] = i < 4 ? 4.0 - i : 0.0;
    start[2] = 1.0;  // an eigenvector
    check(g, 4, 8, start, 1e-13);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_whole_space_is_exact),
        cmocka_unit_test(test_four_steps_each_are_enough),
        cmocka_unit_test(test_exhausted_spaces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
