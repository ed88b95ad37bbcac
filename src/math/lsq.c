#include "math/lsq.h"

#include <cblas.h>
#include <lapacke.h>
#include <pthread.h>

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

void lsq_multiply(int m, int n, int k, const float *a, int lda, const float *b, int ldb, float *c,
                  int ldc)
{
    prepare();
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, m, n, k, 1.0f, a, lda, b, ldb, 0.0f, c,
                ldc);
}
