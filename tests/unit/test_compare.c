#include "test.h"

static struct relume_image noise(int width, int height, uint32_t seed)
{
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, width, height, 3));
    for (int i = 0; i < 3 * width * height; i++)
        image.data[i] = (float)test_uniform(&seed);
    return image;
}

static struct relume_image flat(int width, int height, float value)
{
    struct relume_image image = noise(width, height, 1);
    for (int i = 0; i < 3 * width * height; i++)
        image.data[i] = value;
    return image;
}

static void test_identical(void **state)
{
    (void)state;
    struct relume_image a = noise(40, 23, 3);
    struct relume_difference d;
    CHECK_OK(relume_image_compare(&d, &a, &a, NULL));
    CHECK_NEAR(d.rms, 0.0, 0.0);
    CHECK_NEAR(d.psnr_db, 200.0, 0.0);
    CHECK_NEAR(d.ssim, 1.0, 1e-12);
    CHECK_NEAR(d.delta_e, 0.0, 0.0);
    assert_int_equal(d.pixels, 40 * 23);
    relume_image_destroy(&a);
}

static void test_closed_forms(void **state)
{
    (void)state;
    const struct relume_transfer srgb = {RELUME_CURVE_SRGB, 0.0f};
    const float la = relume_transfer_decode(srgb, 100.0f / 255.0f);
    const float lb = relume_transfer_decode(srgb, 110.0f / 255.0f);
    struct relume_image a = flat(20, 20, la), b = flat(20, 20, lb);
    struct relume_difference d;
    CHECK_OK(relume_image_compare(&d, &a, &b, NULL));
    CHECK_NEAR(d.psnr_db, -20.0 * log10(10.0 / 255.0), 1e-9);  // 10 codes apart everywhere
    CHECK_NEAR(d.mse, 100.0 / 255.0 / 255.0, 1e-7);
    CHECK_NEAR(d.rms, (double)lb - (double)la, 1e-7);
    CHECK_NEAR(d.max_abs, (double)lb - (double)la, 1e-7);
    // flat images have no variance: SSIM is its luminance term
    const double x = 100.0 / 255.0, y = 110.0 / 255.0;
    CHECK_NEAR(d.ssim, (2 * x * y + 1e-4) / (x * x + y * y + 1e-4), 1e-6);

    // half a code is rounded away in psnr_db, not in mse
    relume_image_destroy(&b);
    b = flat(20, 20, relume_transfer_decode(srgb, 100.4f / 255.0f));
    CHECK_OK(relume_image_compare(&d, &a, &b, NULL));
    CHECK_NEAR(d.psnr_db, 200.0, 0.0);
    assert_true(d.mse > 1e-6);

    // above white both are clipped, linear values are not
    relume_image_destroy(&b);
    struct relume_image white = flat(20, 20, 1.0f);
    b = flat(20, 20, 3.0f);
    CHECK_OK(relume_image_compare(&d, &white, &b, NULL));
    CHECK_NEAR(d.psnr_db, 200.0, 0.0);
    CHECK_NEAR(d.rms, 2.0, 1e-12);
    relume_image_destroy(&white);
    relume_image_destroy(&a);
    relume_image_destroy(&b);
}

// SSIM against a direct sum over the 11 x 11 window, without separation.
static void test_ssim_reference(void **state)
{
    (void)state;
    enum { W = 19, H = 14 };
    const struct relume_transfer srgb = {RELUME_CURVE_SRGB, 0.0f};
    struct relume_image a = noise(W, H, 5), b = noise(W, H, 6);
    double luma[2][W * H], sum = 0.0, total = 0.0, g[11];
    int windows = 0;
    for (int i = 0; i < W * H; i++)
        for (int k = 0; k < 2; k++) {
            const float *p = (k ? b : a).data + 3 * i;
            luma[k][i] = 0.299 * relume_transfer_encode(srgb, p[0]) +
                         0.587 * relume_transfer_encode(srgb, p[1]) +
                         0.114 * relume_transfer_encode(srgb, p[2]);
        }
    for (int i = 0; i < 11; i++)
        total += g[i] = exp(-(i - 5) * (i - 5) / 4.5);
    for (int y = 5; y < H - 5; y++)
        for (int x = 5; x < W - 5; x++) {
            double m[5] = {0};
            for (int j = -5; j <= 5; j++)
                for (int i = -5; i <= 5; i++) {
                    const double w = g[j + 5] * g[i + 5] / total / total;
                    const double p = luma[0][(y + j) * W + x + i], q = luma[1][(y + j) * W + x + i];
                    m[0] += w * p, m[1] += w * q, m[2] += w * p * p, m[3] += w * q * q;
                    m[4] += w * p * q;
                }
            sum += (2 * m[0] * m[1] + 1e-4) * (2 * (m[4] - m[0] * m[1]) + 9e-4) /
                   ((m[0] * m[0] + m[1] * m[1] + 1e-4) *
                    (m[2] - m[0] * m[0] + m[3] - m[1] * m[1] + 9e-4));
            windows++;
        }
    struct relume_difference d;
    CHECK_OK(relume_image_compare(&d, &a, &b, NULL));
    CHECK_NEAR(d.ssim, sum / windows, 1e-6);  // luma is kept in single precision
    relume_image_destroy(&a);
    relume_image_destroy(&b);
}

static void test_mask_and_threads(void **state)
{
    (void)state;
    struct relume_image a = noise(50, 70, 8), b = noise(50, 70, 9), mask;
    CHECK_OK(relume_image_create(&mask, 50, 70, 1));
    for (int i = 0; i < 50 * 70; i++)
        mask.data[i] = i % 50 < 25;
    for (int i = 0; i < 50 * 70; i++)  // equal inside, so that only the outside differs
        if (i % 50 < 25)
            memcpy(b.data + 3 * i, a.data + 3 * i, 12);
    struct relume_difference d, e;
    CHECK_OK(relume_image_compare(&d, &a, &b, relume_compare_params(.mask = &mask)));
    CHECK_NEAR(d.rms, 0.0, 0.0);
    CHECK_NEAR(d.psnr_db, 200.0, 0.0);
    assert_int_equal(d.pixels, 25 * 70);
    CHECK_OK(relume_image_compare(&d, &a, &b, relume_compare_params(.threads = 1)));
    CHECK_OK(relume_image_compare(&e, &a, &b, relume_compare_params(.threads = 7)));
    assert_memory_equal(&d, &e, sizeof d);
    assert_true(d.rms > 0.1);
    memset(mask.data, 0, 50 * 70 * sizeof *mask.data);
    CHECK_OK(relume_image_compare(&d, &a, &b, relume_compare_params(.mask = &mask)));
    assert_int_equal(d.pixels, 0);
    assert_true(isnan(d.ssim));
    relume_image_destroy(&a);
    relume_image_destroy(&b);
    relume_image_destroy(&mask);
}

static void test_refusals(void **state)
{
    (void)state;
    struct relume_image a = noise(4, 4, 1), b = noise(4, 5, 1), grey;
    struct relume_difference d;
    CHECK_OK(relume_image_create(&grey, 4, 4, 1));
    assert_int_equal(relume_image_compare(&d, &a, &b, NULL), RELUME_EINVAL);
    assert_int_equal(relume_image_compare(&d, &a, &grey, NULL), RELUME_EINVAL);
    assert_int_equal(relume_image_compare(&d, &a, &a, relume_compare_params(.mask = &b)),
                     RELUME_EINVAL);
    relume_image_destroy(&a);
    relume_image_destroy(&b);
    relume_image_destroy(&grey);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_identical),      cmocka_unit_test(test_closed_forms),
        cmocka_unit_test(test_ssim_reference), cmocka_unit_test(test_mask_and_threads),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
