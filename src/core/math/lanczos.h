// lanczos.h - the leading eigenvectors of a symmetric matrix that is only known by its products
#ifndef MATH_LANCZOS_H
#define MATH_LANCZOS_H

#include <relume/base.h>

// out[n] = matrix v[n]; of a positive semidefinite matrix.
typedef void lanczos_product(const void *context, const double *v, double *out);

// The `count` largest eigenvalues, descending, and their unit eigenvectors vectors[count][n],
// within the space that `steps` products span (count <= steps; at most n are made) from start[n]
// on. Exact for steps >= n; beyond the start, directions that it has nothing of follow where the
// space is exhausted. The sign makes the largest component positive. RELUME_ENOMEM.
relume_status lanczos_eigenvectors(int n, int count, int steps, const double *start,
                                   lanczos_product *product, const void *context, double *values,
                                   double *vectors);

#endif
