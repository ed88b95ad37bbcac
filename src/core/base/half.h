// half.h - IEEE 754 binary16, rounding to nearest even; plain integer code that compilers vectorise
#ifndef BASE_HALF_H
#define BASE_HALF_H

#include <math.h>
#include <stdint.h>
#include <string.h>

static inline uint32_t bits_of_float(float f)
{
    uint32_t u;
    memcpy(&u, &f, sizeof u);
    return u;
}

static inline float float_of_bits(uint32_t u)
{
    float f;
    memcpy(&f, &u, sizeof f);
    return f;
}

static inline float float_from_half(uint16_t h)
{
    const uint32_t magnitude = h & 0x7fffu;
    // Shift exponent and mantissa into place, then let a multiplication rebias (denormals too).
    const float scaled = float_of_bits(magnitude << 13) * float_of_bits((254u - 15u) << 23);
    const uint32_t special = magnitude >= 0x7c00u ? 0x7f800000u | (magnitude << 13) : 0u;
    const uint32_t finite = magnitude >= 0x7c00u ? 0u : bits_of_float(scaled);
    return float_of_bits(finite | special | (uint32_t)(h & 0x8000u) << 16);
}

static inline uint16_t half_from_float(float f)
{
    const uint32_t u = bits_of_float(f);
    const uint32_t magnitude = u & 0x7fffffffu;
    // Halves below 2^-14 are denormal: adding 0.5 lets the FPU round them into the low bits.
    const float shifted = float_of_bits(magnitude < 0x38800000u ? magnitude : 0u) + 0.5f;
    const uint32_t denormal = bits_of_float(shifted) - 0x3f000000u;
    const uint32_t rounded = magnitude + 0x00000fffu + ((magnitude >> 13) & 1u);
    const uint32_t normal = (rounded - (112u << 23)) >> 13;
    uint32_t h = magnitude < 0x38800000u ? denormal : normal;
    h = magnitude >= 0x477ff000u ? 0x7c00u : h;  // 65520 and above round to infinity
    h = magnitude > 0x7f800000u ? 0x7e00u : h;
    return (uint16_t)(h | (u >> 16 & 0x8000u));
}

// To 8 significant bits: steps of a 128th to a 256th, which no display of 8 bits shows. What is too
// large becomes the largest.
static inline uint16_t half_coarse(float f)
{
    const uint32_t u = bits_of_float(f);
    const float coarse = float_of_bits((u + 0x7fffu + (u >> 16 & 1u)) & 0xffff0000u);
    return half_from_float(fminf(fmaxf(coarse, -65504.0f), 65504.0f));
}

#endif
