// test_half.c - tests of src/image/image/half.h: IEEE 754 binary16, rounding to nearest even; plain
// integer code that compilers vectorise
#include "test.h"

#include "core/base/half.h"

static void test_every_half_round_trips(void **state)
{
    (void)state;
    for (uint32_t h = 0; h < 65536; h++) {
        const bool is_nan = (h & 0x7c00) == 0x7c00 && (h & 0x3ff);
        const uint16_t again = half_from_float(float_from_half((uint16_t)h));
        if (is_nan)
            assert_true(isnan(float_from_half((uint16_t)h)) && (again & 0x7fff) > 0x7c00);
        else
            assert_int_equal(again, h);
    }
}

static void test_known_values(void **state)
{
    (void)state;
    static const struct {
        uint16_t half;
        float value;
    } known[] = {{0x3c00, 1.0f},     {0xc000, -2.0f},    {0x7bff, 65504.0f},
                 {0x0400, 0x1p-14f}, {0x0001, 0x1p-24f}, {0x3555, 0.333251953125f},
                 {0x7c00, INFINITY}, {0x8000, -0.0f}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        assert_int_equal(half_from_float(known[i].value), known[i].half);
        assert_true(float_from_half(known[i].half) == known[i].value);
    }
}

// Nearest, ties to even, checked against the two neighbours in double precision.
static void test_rounding(void **state)
{
    (void)state;
    uint32_t seed = 1;
    for (int i = 0; i < 200000; i++) {
        const uint32_t bits = test_random(&seed) << 8 ^ test_random(&seed);
        const float f = float_of_bits(bits);
        if (!(fabsf(f) < 65504.0f))
            continue;
        const uint16_t h = half_from_float(f);
        const double error = fabs((double)float_from_half(h) - (double)f);
        for (int step = -1; step <= 1; step += 2) {
            const uint16_t other = (uint16_t)(h + step);
            if (((h ^ other) & 0x8000) || (other & 0x7c00) == 0x7c00)
                continue;
            const double theirs = fabs((double)float_from_half(other) - (double)f);
            assert_true(error < theirs || (error == theirs && !(h & 1)));
        }
    }
}

static void test_edges(void **state)
{
    (void)state;
    assert_int_equal(half_from_float(65519.99f), 0x7bff);
    assert_int_equal(half_from_float(65520.0f), 0x7c00);
    assert_int_equal(half_from_float(-1e30f), 0xfc00);
    assert_int_equal(half_from_float(0x1p-25f), 0);         // a tie, to even
    assert_int_equal(half_from_float(0x1.000002p-25f), 1);  // just above it
    assert_int_equal(half_from_float(1e-45f), 0);
    assert_true((half_from_float(NAN) & 0x7fff) > 0x7c00);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_half_round_trips),
        cmocka_unit_test(test_known_values),
        cmocka_unit_test(test_rounding),
        cmocka_unit_test(test_edges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
