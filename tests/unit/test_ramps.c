// test_ramps.c - slopes of known pictures
#include "test.h"

enum { W = 96, H = 40 };

// A grey picture of display levels (of 255) level(x, y).
static struct relume_image picture(double (*level)(int x, int y))
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, W, H, 3));
    for (int i = 0; i < W * H; i++)
        for (int c = 0; c < 3; c++)
            image.data[3 * i + c] =
                relume_transfer_decode(srgb, (float)(level(i % W, i / W) / 255.0));
    return image;
}

static double ramp(int x, int y)
{
    return 40.0 + 1.0 * x + 0.5 * y;
}
static double steeper(int x, int y)
{
    return 20.0 + 1.5 * x + 0.5 * y;
}
static double stairs(int x, int y)
{
    return 16.0 * floor(ramp(x, y) / 16.0);
}
static double noisy_stairs(int x, int y)
{
    static const double order[4][4] = {{0.5, 8.5, 2.5, 10.5},
                                       {12.5, 4.5, 14.5, 6.5},
                                       {3.5, 11.5, 1.5, 9.5},
                                       {15.5, 7.5, 13.5, 5.5}};
    return 16.0 * floor((ramp(x, y) + order[y % 4][x % 4]) / 16.0);
}
static double flat(int x, int y)
{
    (void)x, (void)y;
    return 100.0;
}
static double steep(int x, int y)
{
    (void)y;
    return 10.0 * (x % 24);
}

static struct relume_ramps measure(double (*level)(int, int), double (*reference)(int, int))
{
    struct relume_image a = picture(level), b = picture(reference);
    struct relume_ramps r;
    CHECK_OK(relume_image_ramps(&r, &a, &b, NULL));
    relume_image_destroy(&a);
    relume_image_destroy(&b);
    return r;
}

// The border repeats its pixels for smoothing, so that 6 pixels there are bent.
static void test_slopes(void **state)
{
    (void)state;
    struct relume_ramps r = measure(ramp, ramp);
    assert_true(r.pixels > (W - 20) * (H - 20));
    assert_true(r.error == 0.0);
    CHECK_NEAR(r.slope, 1.25, 0.15);
    r = measure(steeper, ramp);
    CHECK_NEAR(r.error, 0.25, 0.03);
    assert_true(measure(ramp, flat).pixels == 0);
    assert_true(measure(ramp, steep).pixels < W * H / 20);
}

// Stairs 16 levels high are flat, then jump: most of the slope is wrong. Noise of the same two
// levels keeps the mean, and so the slope.
static void test_contours(void **state)
{
    (void)state;
    const double stepped = measure(stairs, ramp).error, noisy = measure(noisy_stairs, ramp).error;
    assert_true(stepped > 0.5 * 1.25);
    assert_true(noisy < 0.2 * stepped);
}

static void test_mask_and_sizes(void **state)
{
    (void)state;
    struct relume_image a = picture(stairs), b = picture(ramp), mask, small;
    struct relume_ramps r;
    CHECK_OK(relume_image_create(&mask, W, H, 1));
    CHECK_OK(relume_image_create(&small, W - 1, H, 3));
    CHECK_OK(relume_image_ramps(&r, &a, &b, relume_compare_params(.mask = &mask)));
    assert_true(r.pixels == 0 && r.error == 0.0);
    assert_int_equal(relume_image_ramps(&r, &a, &small, NULL), RELUME_EINVAL);
    assert_int_equal(relume_image_ramps(&r, &a, &mask, NULL), RELUME_EINVAL);
    mask.width = W - 1;
    assert_int_equal(relume_image_ramps(&r, &a, &b, relume_compare_params(.mask = &mask)),
                     RELUME_EINVAL);
    relume_image_destroy(&a);
    relume_image_destroy(&b);
    relume_image_destroy(&mask);
    relume_image_destroy(&small);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slopes),
        cmocka_unit_test(test_contours),
        cmocka_unit_test(test_mask_and_sizes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
