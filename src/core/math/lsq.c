// lsq.c - small dense linear algebra, by Eigen (lsq_eigen.cpp)
#include "core/math/lsq.h"

#include "core/base/memory.h"
#include "core/kernel/kernels.h"
#include "core/kernel/lsq_kernels.h"
#include "core/math/random.h"

#include <math.h>
#include <string.h>

static const struct lsq_kernels *kernels(void)
{
    return kernels_choose(0)->lsq;
}

bool lsq_eigenvalues(double *matrix, int n, double *values)
{
    const bool good = kernels()->eigen(matrix, n, n, values, NULL);
    for (int i = 0; i < n / 2; i++) {
        const double largest = values[i];
        values[i] = values[n - 1 - i];
        values[n - 1 - i] = largest;
    }
    return good;
}

// Where few eigenvectors of a large semidefinite matrix are asked for: blocks of vectors times it,
// again and again, made orthonormal each time (Halko, Martinsson, Tropp 2011); then the small
// problem.
enum { LARGE = 1024, SPARE = 16, POWERS = 12 };

// rows[m][n] -> orthonormal; `small` holds m x m, `next` for another m x n.
static bool orthonormalise(double *rows, int m, int n, double *small, double *next)
{
    for (int again = 0; again < 2; again++) {  // twice: the Gram matrix squares the condition
        double trace = 0.0;
        lsq_product(false, true, m, m, n, rows, rows, small);
        for (int i = 0; i < m; i++)
            trace += small[i * m + i];
        for (int i = 0; i < m; i++)
            small[i * m + i] += 1e-14 * trace;
        if (!lsq_cholesky(small, m) || !lsq_invert_lower(small, m))
            return false;
        lsq_multiply_double(m, n, m, small, rows, next);
        memcpy(rows, next, (size_t)m * (size_t)n * sizeof *rows);
    }
    return true;
}

static bool top_eigenvectors(const double *matrix, int n, int count, double *values,
                             double *vectors)
{
    const int m = count + SPARE;
    const size_t size = (size_t)m * (size_t)n, square = (size_t)m * (size_t)m;
    double *rows = mem_array(size, sizeof *rows), *next = mem_array(size, sizeof *next);
    double *small = mem_array(square, sizeof *small), *turn = mem_array(square, sizeof *turn);
    double *all = mem_array((size_t)m, sizeof *all);
    bool good = rows && next && small && turn && all;
    struct random random = random_stream(1, (uint64_t)n, (uint64_t)count);
    for (size_t i = 0; good && i < size; i++)
        rows[i] = random_range(&random, -1.0, 1.0);
    double shift = 0.0;  // keeps directions alive that the matrix maps to zero
    for (size_t i = 0; i < (size_t)n; i++)
        shift += 1e-12 * matrix[i * (size_t)n + i];
    shift = shift > 0.0 ? shift : 1.0;
    for (int i = 0; good && i < POWERS; i++) {
        good = orthonormalise(rows, m, n, small, next);
        lsq_multiply_double(m, n, n, rows, matrix, next);
        for (size_t j = 0; j < size; j++)
            rows[j] = next[j] + shift * rows[j];
    }
    good = good && orthonormalise(rows, m, n, small, next);
    if (good) {
        lsq_multiply_double(m, n, n, rows, matrix, next);
        lsq_product(false, true, m, m, n, next, rows, small);
        good = lsq_eigenvectors(small, m, m, all, turn);
    }
    if (good) {
        lsq_multiply_double(count, n, m, turn, rows, vectors);
        memcpy(values, all, (size_t)count * sizeof *values);
    }
    mem_free(rows);
    mem_free(next);
    mem_free(small);
    mem_free(turn);
    mem_free(all);
    return good;
}

// The sign is open; the largest component becomes positive.
static void fix_sign(double *v, int n)
{
    int top = 0;
    for (int i = 1; i < n; i++)
        top = fabs(v[i]) > fabs(v[top]) ? i : top;
    const double sign = v[top] < 0.0 ? -1.0 : 1.0;
    for (int i = 0; i < n; i++)
        v[i] *= sign;
}

bool lsq_eigenvectors(double *matrix, int n, int count, double *values, double *vectors)
{
    const bool few = n > LARGE && count < n / 8;
    const bool good = few ? top_eigenvectors(matrix, n, count, values, vectors)
                          : kernels()->eigen(matrix, n, count, values, vectors);
    for (int i = 0; good && i < count; i++)
        fix_sign(vectors + (size_t)i * (size_t)n, n);
    return good;
}

bool lsq_solve(double *matrix, int n, double *b, int count)
{
    return kernels()->cholesky(matrix, n) && kernels()->cholesky_solve(matrix, n, b, count);
}

relume_status lsq_invert(double *matrix, int n)
{
    bool singular = false;
    if (!kernels()->invert(matrix, n, &singular))
        return RELUME_ENOMEM;
    return singular ? RELUME_EUNFIT : RELUME_OK;
}

void lsq_add_gram(double *gram, int n, const double *rows, int count)
{
    kernels()->add_gram(gram, n, rows, count);
    for (size_t i = 0; i < (size_t)n; i++)
        for (size_t j = 0; j < i; j++)
            gram[j * (size_t)n + i] = gram[i * (size_t)n + j];
}

bool lsq_cholesky(double *matrix, int n)
{
    if (!kernels()->cholesky(matrix, n))
        return false;
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++)
            matrix[(size_t)i * (size_t)n + (size_t)j] = 0.0;
    return true;
}

bool lsq_invert_lower(double *factor, int n)
{
    return kernels()->invert_lower(factor, n);
}

bool lsq_roots(double *matrix, int n, double *root, double *inverse)
{
    const size_t size = (size_t)n;
    double *values = mem_array(size, sizeof *values);
    double *vectors = mem_array(size * size, sizeof *vectors);  // [n][n], a row each
    double *scaled = mem_array(size * size, sizeof *scaled);
    double *columns = mem_array(size * size, sizeof *columns);
    const bool good = values && vectors && scaled && columns &&
                      lsq_eigenvectors(matrix, n, n, values, vectors) && values[n - 1] > 0.0;
    for (int side = 0; good && side < 2; side++) {
        for (size_t i = 0; i < size; i++)
            for (size_t j = 0; j < size; j++) {
                const double s = side ? 1.0 / sqrt(values[i]) : sqrt(values[i]);
                columns[j * size + i] = vectors[i * size + j];
                scaled[i * size + j] = s * vectors[i * size + j];
            }
        lsq_multiply_double(n, n, n, columns, scaled, side ? inverse : root);
    }
    mem_free(values);
    mem_free(vectors);
    mem_free(scaled);
    mem_free(columns);
    return good;
}

void lsq_product(bool turn_a, bool turn_b, int m, int n, int k, const double *a, const double *b,
                 double *c)
{
    const struct lsq_shape shape = {m, n, k, turn_a ? m : k, turn_b ? k : n, n, turn_a, turn_b};
    kernels()->multiply_double(shape, a, b, c);
}

void lsq_multiply_double(int m, int n, int k, const double *a, const double *b, double *c)
{
    lsq_product(false, false, m, n, k, a, b, c);
}

void lsq_multiply(int m, int n, int k, const float *a, int lda, const float *b, int ldb, float *c,
                  int ldc)
{
    kernels()->multiply((struct lsq_shape){m, n, k, lda, ldb, ldc, false, false}, a, b, c);
}
