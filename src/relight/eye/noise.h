// noise.h - value noise in one dimension (Ebert et al. 2003, Texturing and Modeling)
#ifndef POST_NOISE_H
#define POST_NOISE_H

#include "core/math/random.h"

#include <math.h>

static inline double noise_lattice(uint64_t key, double i)
{
    struct random r = random_stream(key, (uint64_t)(int64_t)i, 0x6e6f697365u);
    return random_range(&r, -1.0, 1.0);
}

// In [-1, 1], smooth, one random value at every whole `x`.
static inline double noise_value(uint64_t key, double x)
{
    const double i = floor(x), f = x - i, s = f * f * (3.0 - 2.0 * f);
    return (1.0 - s) * noise_lattice(key, i) + s * noise_lattice(key, i + 1.0);
}

// Three octaves, each twice as fast and half as strong as the one before; in [-1, 1].
static inline double noise_octaves(uint64_t key, double x)
{
    return (noise_value(key, x) + 0.5 * noise_value(key + 1, 2.0 * x) +
            0.25 * noise_value(key + 2, 4.0 * x)) /
           1.75;
}

#endif
