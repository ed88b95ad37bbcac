// lsq.h - small dense linear algebra; the one place that knows BLAS and LAPACK
//
// Matrices are row by row. BLAS is told to use one thread for the whole process on first use: the
// library brings its own threads, and equal bits for any number of them need a fixed order of sums.
#ifndef MATH_LSQ_H
#define MATH_LSQ_H

#include <relume/base.h>

// Eigenvalues of the symmetric n x n matrix, ascending; the matrix is destroyed. False: no memory.
bool lsq_eigenvalues(double *matrix, int n, double *values);

// Replace the lower triangle of a symmetric positive definite matrix by its Cholesky factor, the
// rest by zeros. False when it is not positive definite.
bool lsq_cholesky(double *matrix, int n);

// The inverse of a lower triangular matrix, in place.
bool lsq_invert_lower(double *factor, int n);

// c[m][n] = a[m][k] b[k][n]; row strides are lda, ldb, ldc.
void lsq_multiply(int m, int n, int k, const float *a, int lda, const float *b, int ldb, float *c,
                  int ldc);

#endif
