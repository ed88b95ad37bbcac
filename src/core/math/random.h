// random.h - counter-based random numbers: a draw depends on its key and its number, not on history
//
// The mixer is SplitMix64 (Steele, Lea, Flood 2014). A stream per (seed, pixel, sample) makes the
// picture independent of threads, tiles and the lights that are rendered.
#ifndef MATH_RANDOM_H
#define MATH_RANDOM_H

#include <stdint.h>

static inline uint64_t random_mix(uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

struct random {
    uint64_t key, count;
};

static inline struct random random_stream(uint64_t seed, uint64_t a, uint64_t b)
{
    return (struct random){.key = random_mix(random_mix(random_mix(seed) ^ a) ^ b)};
}

// Uniform in [0, 1).
static inline double random_next(struct random *r)
{
    return (double)(random_mix(r->key ^ random_mix(r->count++)) >> 11) * 0x1p-53;
}

// Uniform in [low, high).
static inline double random_range(struct random *r, double low, double high)
{
    return low + (high - low) * random_next(r);
}

#endif
