#include "math/lsq.h"

#include "base/memory.h"
#include "math/random.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <pthread.h>
#include <string.h>

static void one_thread(void)
{
    openblas_set_num_threads(1);
}

static void prepare(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, one_thread);
}

bool lsq_eigenvalues(double *matrix, int n, double *values)
{
    prepare();
    return LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'L', n, matrix, n, values) == 0;
}

// Where few eigenvectors of a large semidefinite matrix are asked for: blocks of vectors times it,
// again and again, made orthonormal each time (Halko, Martinsson, Tropp 2011); then the small
// problem.
enum { LARGE = 1024, SPARE = 16, POWERS = 12 };

// rows[m][n] -> orthonormal; `small` has room for m x m.
static bool orthonormalise(double *rows, int m, int n, double *small)
{
    for (int again = 0; again < 2; again++) {  // twice: the Gram matrix squares the condition
        double trace = 0.0;
        cblas_dsyrk(CblasRowMajor, CblasLower, CblasNoTrans, m, n, 1.0, rows, n, 0.0, small, m);
        for (int i = 0; i < m; i++)
            trace += small[i * m + i];
        for (int i = 0; i < m; i++)
            small[i * m + i] += 1e-14 * trace;
        if (!lsq_cholesky(small, m))
            return false;
        cblas_dtrsm(CblasRowMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, m, n, 1.0,
                    small, m, rows, n);
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
        good = orthonormalise(rows, m, n, small);
        lsq_multiply_double(m, n, n, rows, matrix, next);
        for (size_t j = 0; j < size; j++)
            rows[j] = next[j] + shift * rows[j];
    }
    good = good && orthonormalise(rows, m, n, small);
    if (good) {
        lsq_multiply_double(m, n, n, rows, matrix, next);
        cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, m, m, n, 1.0, next, n, rows, n, 0.0,
                    small, m);
        good = lsq_eigenvectors(small, m, m, all, turn);
    }
    if (good) {
        lsq_multiply_double(count, n, m, turn, rows, vectors);
        memcpy(values, all, (size_t)count * sizeof *values);
    }
    free(rows);
    free(next);
    free(small);
    free(turn);
    free(all);
    return good;
}

// The sign is open; the largest component becomes positive.
static void fix_sign(double *v, int n)
{
    const int top = (int)cblas_idamax(n, v, 1);
    if (v[top] < 0.0)
        cblas_dscal(n, -1.0, v, 1);
}

bool lsq_eigenvectors(double *matrix, int n, int count, double *values, double *vectors)
{
    prepare();
    const size_t size = (size_t)n;
    if (n > LARGE && count < n / 8) {
        const bool good = top_eigenvectors(matrix, n, count, values, vectors);
        for (int i = 0; good && i < count; i++)
            fix_sign(vectors + (size_t)i * size, n);
        return good;
    }
    double *all = mem_array(size, sizeof *all);
    double *columns = mem_array(size * (size_t)count, sizeof *columns);  // [n][count], ascending
    lapack_int *support = mem_array(2 * (size_t)count, sizeof *support);
    lapack_int found = 0;
    const bool good = all && columns && support &&
                      !LAPACKE_dsyevr(LAPACK_ROW_MAJOR, 'V', 'I', 'L', n, matrix, n, 0.0, 0.0,
                                      n - count + 1, n, 0.0, &found, all, columns, count, support);
    for (int i = 0; good && i < count; i++) {
        values[i] = all[count - 1 - i];
        for (size_t j = 0; j < size; j++)
            vectors[(size_t)i * size + j] = columns[j * (size_t)count + (size_t)(count - 1 - i)];
        fix_sign(vectors + (size_t)i * size, n);
    }
    free(all);
    free(columns);
    free(support);
    return good && found == count;
}

bool lsq_solve(double *matrix, int n, double *b, int count)
{
    prepare();
    // by columns, the lower triangle is the upper one and a right side is a column
    return LAPACKE_dposv_work(LAPACK_COL_MAJOR, 'U', n, count, matrix, n, b, n) == 0;
}

relume_status lsq_invert(double *matrix, int n)
{
    prepare();
    lapack_int *pivots = mem_array((size_t)n, sizeof *pivots);
    if (!pivots)
        return RELUME_ENOMEM;
    const bool good = !LAPACKE_dgetrf(LAPACK_ROW_MAJOR, n, n, matrix, n, pivots) &&
                      !LAPACKE_dgetri(LAPACK_ROW_MAJOR, n, matrix, n, pivots);
    free(pivots);
    return good ? RELUME_OK : RELUME_EDATA;
}

void lsq_add_gram(double *gram, int n, const double *rows, int count)
{
    prepare();
    cblas_dsyrk(CblasRowMajor, CblasLower, CblasTrans, n, count, 1.0, rows, n, 1.0, gram, n);
    for (size_t i = 0; i < (size_t)n; i++)
        for (size_t j = 0; j < i; j++)
            gram[j * (size_t)n + i] = gram[i * (size_t)n + j];
}

bool lsq_cholesky(double *matrix, int n)
{
    prepare();
    if (LAPACKE_dpotrf(LAPACK_ROW_MAJOR, 'L', n, matrix, n))
        return false;
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++)
            matrix[(size_t)i * (size_t)n + (size_t)j] = 0.0;
    return true;
}

bool lsq_invert_lower(double *factor, int n)
{
    prepare();
    return LAPACKE_dtrtri(LAPACK_ROW_MAJOR, 'L', 'N', n, factor, n) == 0;
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
    free(values);
    free(vectors);
    free(scaled);
    free(columns);
    return good;
}

void lsq_multiply_double(int m, int n, int k, const double *a, const double *b, double *c)
{
    prepare();
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, m, n, k, 1.0, a, k, b, n, 0.0, c, n);
}

void lsq_multiply(int m, int n, int k, const float *a, int lda, const float *b, int ldb, float *c,
                  int ldc)
{
    prepare();
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, m, n, k, 1.0f, a, lda, b, ldb, 0.0f, c,
                ldc);
}

void lsq_product(bool turn_a, bool turn_b, int m, int n, int k, const double *a, const double *b,
                 double *c)
{
    prepare();
    cblas_dgemm(CblasRowMajor, turn_a ? CblasTrans : CblasNoTrans,
                turn_b ? CblasTrans : CblasNoTrans, m, n, k, 1.0, a, turn_a ? m : k, b,
                turn_b ? k : n, 0.0, c, n);
}
