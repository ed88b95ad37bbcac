// float_steps.c - whole numbers that rise with a float, looked up
#include "core/math/float_steps.h"

static const uint32_t INFINITE = 0x7f800000u;

// Bits of the least float, from `from` on, whose step is at least `step`; INFINITE + 1 if every
// step is lower.
static uint32_t find_least(int (*step_of)(float v), int step, uint32_t from)
{
    uint32_t below = from, above = INFINITE + 1;
    if (step_of(float_of_bits(from)) >= step)
        return from;
    while (above - below > 1) {
        const uint32_t middle = below + (above - below) / 2;
        if (step_of(float_of_bits(middle)) >= step)
            above = middle;
        else
            below = middle;
    }
    return above;
}

void float_steps_init(struct float_steps *s, int (*step_of)(float v), int top)
{
    s->least[0] = 0;
    for (int i = 1; i <= top; i++)
        s->least[i] = find_least(step_of, i, s->least[i - 1]);
    s->least[top + 1] = UINT32_MAX;
    int step = 0;
    for (uint32_t i = 0; i <= FLOAT_STEPS_ENTRIES; i++) {
        while (i << FLOAT_STEPS_SHIFT >= s->least[step + 1])
            step++;
        s->start[i] = (uint16_t)step;
    }
}
