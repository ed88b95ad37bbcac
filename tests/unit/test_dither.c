// Bands along the contours of a plain ramp beside a rough patch: where they lie, and what a budget
// leaves of them.
#include "test.h"

#include "format/codebook/dither.h"

enum { PATCH = 16, RAMP = 64, W = PATCH + RAMP, H = 16, CODES = 4 };

static const float vectors[CODES] = {0.0f, 1.0f, 2.0f, 3.0f};
static float ramp[W];
static uint16_t before[W * H], after[W * H];

static double value(int x)
{
    return x < PATCH ? 3.0 * (x % 2) : 3.0 * (x - PATCH + 0.25) / RAMP;
}

static void dither(double share)
{
    struct dither d;
    CHECK_OK(dither_open(&d, vectors, CODES, 1, W, H, share, 1));
    for (int x = 0; x < W; x++)
        ramp[x] = (float)value(x);
    for (int i = 0; i < W * H; i++) {
        before[i] = after[i] = (uint16_t)lround(value(i % W));
        dither_offer(&d, (size_t)(i % W), (size_t)(i / W), before[i], &ramp[i % W], ramp);
    }
    CHECK_OK(dither_spend(&d, after));
    dither_close(&d);
}

static int changed(void)
{
    int count = 0;
    for (int i = 0; i < W * H; i++)
        count += after[i] != before[i];
    return count;
}

// A quarter of the way on either side of the middle, half of the pixels there.
static void bands_lie_along_contours(void **state)
{
    (void)state;
    dither(1.0);
    int in_bands = 0;
    for (int i = 0; i < W * H; i++) {
        const double part = fabs(value(i % W) - before[i]);
        in_bands += part > 0.25;
        if (after[i] != before[i]) {
            assert_true(part > 0.25);
            assert_int_equal(after[i], before[i] + (value(i % W) > before[i] ? 1 : -1));
        }
    }
    // to the columns at a band's ends
    CHECK_NEAR(changed(), in_bands / 2, 6 * H / 2);
}

// Three contours of H edges each; a pixel of a band counts as a quarter of an edge. Equal lengths
// go by the codes.
static void budget_takes_whole_contours(void **state)
{
    (void)state;
    dither(1.0);
    const int all = changed();
    dither(0.05);
    assert_int_equal(changed(), 0);
    dither(0.25);
    CHECK_NEAR(changed(), all / 3, H);
    for (int i = 0; i < W * H; i++)
        if (after[i] != before[i])
            assert_int_equal(after[i] + before[i], 1);
}

// Four pixels that go half of the way are an edge, not a ramp.
static void steep_ramps_are_left(void **state)
{
    (void)state;
    struct dither d;
    CHECK_OK(dither_open(&d, vectors, CODES, 1, W, 1, 1.0, 1));
    for (int x = 0; x < W; x++)
        ramp[x] = (float)(0.2 * x);
    for (size_t x = 0; x < 15; x++) {
        const uint16_t code = (uint16_t)lroundf(ramp[x]);
        dither_offer(&d, x, 0, code, &ramp[x], ramp);
        assert_int_equal(d.other[x], code);
    }
    dither_close(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bands_lie_along_contours),
        cmocka_unit_test(budget_takes_whole_contours),
        cmocka_unit_test(steep_ramps_are_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
