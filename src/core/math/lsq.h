// lsq.h - small dense linear algebra, by Eigen (lsq_eigen.cpp)
//
// Matrices are row by row. Every call runs in its caller's thread: the library brings its own
// threads, and equal bits for any number of them need a fixed order of sums.
#ifndef MATH_LSQ_H
#define MATH_LSQ_H

#include <relume/base.h>

// Eigenvalues of the symmetric n x n matrix, ascending; the matrix is destroyed. False: no memory.
bool lsq_eigenvalues(double *matrix, int n, double *values);

// The `count` largest eigenvalues, descending, and their unit eigenvectors vectors[count][n] of the
// symmetric n x n matrix; the matrix is destroyed. The sign makes the largest component positive.
// Of more than 1024 rows the matrix must be positive semidefinite.
bool lsq_eigenvectors(double *matrix, int n, int count, double *values, double *vectors);

// Solve matrix x = b for `count` right sides b[count][n], in place; of the symmetric positive
// definite matrix the lower triangle is read, and destroyed. False when it is not positive
// definite.
bool lsq_solve(double *matrix, int n, double *b, int count);

// The inverse of a square matrix, in place. RELUME_EUNFIT when it is singular, RELUME_ENOMEM.
relume_status lsq_invert(double *matrix, int n);

// gram[n][n] += rows^T rows for rows[count][n]; both triangles.
void lsq_add_gram(double *gram, int n, const double *rows, int count);

// Replace the lower triangle of a symmetric positive definite matrix by its Cholesky factor, the
// rest by zeros. False when it is not positive definite.
bool lsq_cholesky(double *matrix, int n);

// The inverse of a lower triangular matrix, in place.
bool lsq_invert_lower(double *factor, int n);

// The symmetric square root of a positive definite matrix and its inverse; the matrix is destroyed.
bool lsq_roots(double *matrix, int n, double *root, double *inverse);

// c[m][n] = a[m][k] b[k][n] in double precision.
void lsq_multiply_double(int m, int n, int k, const double *a, const double *b, double *c);

// c[m][n] = a[m][k] b[k][n]; row strides are lda, ldb, ldc.
void lsq_multiply(int m, int n, int k, const float *a, int lda, const float *b, int ldb, float *c,
                  int ldc);

// c[m][n] = a b, or the transposes of what is stored: a is [m][k], turned [k][m]; b is [k][n],
// turned [n][k].
void lsq_product(bool turn_a, bool turn_b, int m, int n, int k, const double *a, const double *b,
                 double *c);

#endif
