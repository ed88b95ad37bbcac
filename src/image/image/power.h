// power.h - x^p for many x by a table: pow() is what comparing images would spend its time in
#ifndef IMAGE_POWER_H
#define IMAGE_POWER_H

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { POWER_OCTAVES = 10, POWER_STEPS = 128 };
#define POWER_MIN 0x1p-9
#define POWER_MAX 2.0

// Parabolas through x^p at the ends and the middle of every 128th part of an octave: within
// 1e-8 of the value, relatively, for exponents in [0.2, 1].
struct power {
    double part[POWER_OCTAVES * POWER_STEPS][3];
};

static inline void power_init(struct power *table, double exponent)
{
    for (int i = 0; i < POWER_OCTAVES * POWER_STEPS; i++) {
        const double octave = ldexp(POWER_MIN, i / POWER_STEPS);
        const double from = octave * (1.0 + i % POWER_STEPS / (double)POWER_STEPS);
        const double width = octave / POWER_STEPS;
        const double first = pow(from, exponent);
        const double middle = pow(from + 0.5 * width, exponent);
        const double last = pow(from + width, exponent);
        table->part[i][0] = first;
        table->part[i][1] = 4.0 * middle - 3.0 * first - last;
        table->part[i][2] = 2.0 * (first + last) - 4.0 * middle;
    }
}

// x^p for x in [POWER_MIN, POWER_MAX).
static inline double power_of(const struct power *table, double x)
{
    enum { MANTISSA = 52, STEP_BITS = 7 };
    const uint64_t one = (uint64_t)1023 << MANTISSA;
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    const uint64_t base = (uint64_t)(1023 - 9) << STEP_BITS;
    const double *c = table->part[(bits >> (MANTISSA - STEP_BITS)) - base];
    bits = ((bits << STEP_BITS) & (((uint64_t)1 << MANTISSA) - 1)) | one;
    double u;
    memcpy(&u, &bits, sizeof u);
    u -= 1.0;
    return c[0] + u * (c[1] + u * c[2]);
}

#endif
