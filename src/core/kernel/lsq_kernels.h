// lsq_kernels.h - what lsq.c asks of Eigen, one table for each kind of CPU
//
// Matrices are row by row. Nothing here throws: what needs memory says false when there is none.
#ifndef KERNEL_LSQ_KERNELS_H
#define KERNEL_LSQ_KERNELS_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

// Rows and columns of a product c[m][n] = a[m][k] b[k][n], and the strides of the rows as stored.
struct lsq_shape {
    int m, n, k;
    int lda, ldb, ldc;
    bool turn_a, turn_b;  // a is stored [k][m], b [n][k]
};

struct lsq_kernels {
    void (*multiply)(struct lsq_shape s, const float *a, const float *b, float *c);
    void (*multiply_double)(struct lsq_shape s, const double *a, const double *b, double *c);
    // Lower triangle of gram[n][n] += rows^T rows, rows[count][n].
    void (*add_gram)(double *gram, int n, const double *rows, int count);
    // The largest `count` eigenvalues, descending; vectors[count][n] may be NULL.
    bool (*eigen)(const double *matrix, int n, int count, double *values, double *vectors);
    // In place, the lower triangle only; false when the matrix is not positive definite.
    bool (*cholesky)(double *matrix, int n);
    // factor factor^T x = b for b[count][n], in place.
    bool (*cholesky_solve)(const double *factor, int n, double *b, int count);
    // In place, the lower triangle only.
    bool (*invert_lower)(double *factor, int n);
    bool (*invert)(double *matrix, int n, bool *singular);
};

extern const struct lsq_kernels lsq_kernels_plain, lsq_kernels_avx2, lsq_kernels_avx512;

#ifdef __cplusplus
}
#endif

#endif
