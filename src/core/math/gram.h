// gram.h - Gram matrices of many rows, summed on several cores
#ifndef MATH_GRAM_H
#define MATH_GRAM_H

#include <relume/base.h>

// gram[n][n] = rows^T rows, both triangles, for rows[count][n] that `fill` writes, some at a time
// and in several threads. Parts are summed in a fixed order: same bits for any thread count.
// RELUME_ENOMEM.
relume_status gram_sum(double *gram, size_t n, size_t count,
                       void (*fill)(const void *context, size_t first, size_t rows, double *out),
                       const void *context, int threads);

#endif
