// float_steps.h - whole numbers that rise with a float, looked up: the same as what they are made
// of at every float, in a few cycles
#ifndef MATH_FLOAT_STEPS_H
#define MATH_FLOAT_STEPS_H

#include "core/base/half.h"

// Floats that share their exponent and the first 6 bits of their mantissa share an entry.
enum { FLOAT_STEPS = 1284, FLOAT_STEPS_SHIFT = 17, FLOAT_STEPS_ENTRIES = 0x7f800000 >> 17 };

struct float_steps {
    uint16_t start[FLOAT_STEPS_ENTRIES + 1];  // the step of an entry's least float
    uint32_t least[FLOAT_STEPS + 1];          // bits of the least float of each step
};

// `step_of` is 0 at 0, never falls and is at most `top` at infinity, FLOAT_STEPS - 1 at most.
void float_steps_init(struct float_steps *s, int (*step_of)(float v), int top);

// 0 of what is not above 0, or no number.
static inline int float_step(const struct float_steps *s, float v)
{
    const uint32_t bits = bits_of_float(v > 0.0f ? v : 0.0f);
    int step = s->start[bits >> FLOAT_STEPS_SHIFT];
    while (bits >= s->least[step + 1])
        step++;
    return step;
}

#endif
