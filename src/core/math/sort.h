// sort.h - numbers in ascending order
#ifndef MATH_SORT_H
#define MATH_SORT_H

#include <stdlib.h>

static inline int sort_by_double(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static inline int sort_by_float(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static inline void sort_doubles(double *values, size_t n)
{
    qsort(values, n, sizeof *values, sort_by_double);
}

static inline void sort_floats(float *values, size_t n)
{
    qsort(values, n, sizeof *values, sort_by_float);
}

#endif
