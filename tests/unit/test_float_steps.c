// test_float_steps.c - tests of src/core/math/float_steps.h: what is looked up is what is
// calculated
#include "test.h"

#include "core/math/float_steps.h"

#include <math.h>

static int calls;

static int tenths(float v)
{
    calls++;
    return v >= 25.5f ? 255 : (int)(v * 10.0f);
}

static int octaves(float v)
{
    const float place = v > 0.0f ? (log2f(v) + 40.0f) * 16.0f : -1.0f;
    return place < 0.0f ? 0 : place < 1280.0f ? 1 + (int)place : 1281;
}

static void compare(const struct float_steps *s, int (*step_of)(float), uint32_t bits)
{
    const float v = float_of_bits(bits);
    if (float_step(s, v) != step_of(v))
        fail_msg("%a: %d, expected %d", (double)v, float_step(s, v), step_of(v));
}

// Around every step, and at floats of every size.
static void compare_all(int (*step_of)(float), int top)
{
    struct float_steps s;
    float_steps_init(&s, step_of, top);
    for (int i = 1; i <= top; i++)
        for (uint32_t k = 0; k < 9; k++)
            if (s.least[i] + k - 4 <= 0x7f800000u)
                compare(&s, step_of, s.least[i] + k - 4);
    for (uint32_t bits = 0; bits <= 0x7f800000u; bits += 9973)
        compare(&s, step_of, bits);
    compare(&s, step_of, 0x7f800000u);
}

static void test_steps(void **state)
{
    (void)state;
    compare_all(tenths, 255);
    compare_all(octaves, 1281);
}

static void test_no_light(void **state)
{
    struct float_steps s;
    (void)state;
    float_steps_init(&s, tenths, 255);
    calls = 0;
    assert_int_equal(float_step(&s, -1.0f), 0);
    assert_int_equal(float_step(&s, -INFINITY), 0);
    assert_int_equal(float_step(&s, NAN), 0);
    assert_int_equal(float_step(&s, 25.5f), 255);
    assert_int_equal(calls, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_steps),
        cmocka_unit_test(test_no_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
