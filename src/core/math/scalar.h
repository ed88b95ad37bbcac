// scalar.h - functions of one number
#ifndef MATH_SCALAR_H
#define MATH_SCALAR_H

#include <math.h>
#include <stddef.h>

static inline int smaller_of(int a, int b)
{
    return a < b ? a : b;
}

static inline int larger_of(int a, int b)
{
    return a > b ? a : b;
}

// From 0 at `low` to 1 at `high`, level at both ends.
static inline double smoothstep(double low, double high, double x)
{
    const double t = fmin(fmax((x - low) / (high - low), 0.0), 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// PSNR of a mean squared error of values in [0, 1]; at most 200.
static inline double decibels(double mse)
{
    return mse > 1e-20 ? fmin(-10.0 * log10(mse), 200.0) : 200.0;
}

// to[i] += factor * from[i]; they do not overlap.
static inline void add_scaled(float *restrict to, const float *restrict from, float factor,
                              size_t n)
{
    for (size_t i = 0; i < n; i++)
        to[i] += factor * from[i];
}

#endif
