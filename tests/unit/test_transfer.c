// test_transfer.c - transfer curves against their formulas
#include "test.h"

static const struct relume_transfer linear = {.curve = RELUME_CURVE_LINEAR};
static const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};

static void test_srgb_known_values(void **state)
{
    (void)state;
    // IEC 61966-2-1: 18 % grey and both ends; code 128 of 255 is 0.21586 linear
    CHECK_NEAR(relume_transfer_encode(srgb, 0.18f), 0.46135613, 1e-6);
    CHECK_NEAR(relume_transfer_decode(srgb, 128.0f / 255.0f), 0.2158605, 1e-6);
    CHECK_NEAR(relume_transfer_decode(srgb, 0.0f), 0.0, 0.0);
    CHECK_NEAR(relume_transfer_decode(srgb, 1.0f), 1.0, 1e-7);
    // the linear piece, and its joint: both sides agree to 1e-7 in the standard's own numbers
    CHECK_NEAR(relume_transfer_decode(srgb, 0.02f), 0.02 / 12.92, 1e-9);
    CHECK_NEAR(relume_transfer_decode(srgb, 0.04045f), relume_transfer_decode(srgb, 0.040451f),
               2e-7);
}

static void test_round_trips(void **state)
{
    (void)state;
    const struct relume_transfer curves[] = {linear,
                                             srgb,
                                             {.curve = RELUME_CURVE_GAMMA, .gamma = 2.2f},
                                             {.curve = RELUME_CURVE_GAMMA, .gamma = 0.5f}};
    for (size_t i = 0; i < sizeof curves / sizeof *curves; i++)
        for (int v = -300; v <= 300; v++) {
            const float code = (float)v / 100.0f;
            const float again =
                relume_transfer_encode(curves[i], relume_transfer_decode(curves[i], code));
            // powf is exact to a few units in the last place; the exponents multiply that by < 3
            CHECK_NEAR(again, code, 1e-5 * (1.0 + fabs(code)));
        }
}

static void test_curves_are_odd(void **state)
{
    (void)state;
    for (int v = 0; v <= 200; v++)
        assert_true(relume_transfer_decode(srgb, -(float)v / 100) ==
                    -relume_transfer_decode(srgb, (float)v / 100));
}

// ln(delta + v), moved and scaled so that black is 0 and white 1; in double precision.
static double log_of(double delta, double v)
{
    return (log(delta + v) - log(delta)) / (log(delta + 1.0) - log(delta));
}

static void test_logarithm(void **state)
{
    (void)state;
    static const float deltas[] = {1e-6f, 1e-3f, 0.05f, 1.0f};
    for (size_t k = 0; k < sizeof deltas / sizeof *deltas; k++) {
        const struct relume_transfer t = {.curve = RELUME_CURVE_LOG, .gamma = deltas[k]};
        const double delta = (double)deltas[k];
        CHECK_NEAR(relume_transfer_encode(t, 0.0f), 0.0, 0.0);
        CHECK_NEAR(relume_transfer_encode(t, -0.2f), 0.0, 0.0);  // no light is black
        CHECK_NEAR(relume_transfer_decode(t, 0.0f), 0.0, 0.0);
        CHECK_NEAR(relume_transfer_encode(t, 1.0f), 1.0, 2e-7);
        for (double v = 1e-7; v < 1e5; v *= 1.7) {
            const float code = relume_transfer_encode(t, (float)v);
            // 1 + v / delta is rounded to 2^-24, its logarithm once more
            CHECK_NEAR(code, log_of(delta, v), 3e-7 * fmax(1.0, log_of(delta, v)));
            // the code's rounding times the slope, which is at most (v + delta) ln(1 + 1 / 1e-6)
            CHECK_NEAR(relume_transfer_decode(t, code), v, 6e-6 * (v + delta));
        }
        // what components say below black stays above -delta, above all light finite
        for (float code = -0.5f; code > -1e6f; code *= 9.0f) {
            const float v = relume_transfer_decode(t, code);
            assert_true(v < 0.0f && v >= -deltas[k]);
        }
        assert_true(isfinite(relume_transfer_decode(t, 1e30f)));
    }
}

static void test_parse_and_text(void **state)
{
    (void)state;
    struct relume_transfer t;
    char text[32];
    static const char *const good[] = {"linear",     "srgb",      "gamma:2.2", "gamma:1",
                                       "gamma:0.45", "log:0.001", "log:1",     "log:1e-06"};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        CHECK_OK(relume_transfer_parse(&t, good[i]));
        relume_transfer_text(t, text, sizeof text);
        assert_string_equal(text, good[i]);
    }
    static const char *const bad[] = {
        "",         "SRGB",      "gamma",      "gamma:",    "gamma:0", "gamma:-1",
        "gamma:11", "gamma:nan", "gamma:2.2x", "gamma:inf", "linear ", "log",
        "log:",     "log:0",     "log:2",      "log:-1",    "log:nan", "log:0.1x"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(relume_transfer_parse(&t, bad[i]), RELUME_EINVAL);
    relume_transfer_text(srgb, text, 3);
    assert_string_equal(text, "sr");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_srgb_known_values), cmocka_unit_test(test_round_trips),
        cmocka_unit_test(test_curves_are_odd),    cmocka_unit_test(test_logarithm),
        cmocka_unit_test(test_parse_and_text),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
