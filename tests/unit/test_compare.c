// test_compare.c - error measures against their definitions
#include "test.h"

#include "image/compare/ciede2000.h"
#include "image/image/encoder.h"

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
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
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
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
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

static double exact_code(double linear)
{
    const double v = fmin(fmax(linear, 0.0), 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
}

static void exact_lab(double lab[3], const float rgb[3])
{
    static const double xyz[3][3] = {{0.4124564, 0.3575761, 0.1804375},
                                     {0.2126729, 0.7151522, 0.0721750},
                                     {0.0193339, 0.1191920, 0.9503041}};
    static const double white[3] = {0.95047, 1.0, 1.08883};
    double f[3];
    for (int i = 0; i < 3; i++) {
        double t = 0.0;
        for (int c = 0; c < 3; c++)
            t += xyz[i][c] * fmin(fmax((double)rgb[c], 0.0), 1.0) / white[i];
        f[i] = t > 216.0 / 24389.0 ? cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
    }
    lab[0] = 116.0 * f[1] - 16.0;
    lab[1] = 500.0 * (f[0] - f[1]);
    lab[2] = 200.0 * (f[1] - f[2]);
}

// What the tables and the vector code say, against powers in double precision: 1e-6 of each figure.
static void test_slow_reference(void **state)
{
    (void)state;
    enum { W = 211, H = 97, N = W * H };
    struct relume_image a = noise(W, H, 21), b = noise(W, H, 22);
    double display = 0.0, coded = 0.0, delta_e = 0.0;
    for (int i = 0; i < 3 * N; i++) {  // dark, bright, negative and above white; near each other
        const float v = a.data[i] * a.data[i] * a.data[i] * 1.1f - 0.002f;
        b.data[i] = v + 0.1f * v * (b.data[i] - 0.5f);
        a.data[i] = v;
    }
    for (int i = 0; i < N; i++) {
        double lab[2][3];
        for (int c = 0; c < 3; c++) {
            const double p = exact_code((double)a.data[3 * i + c]);
            const double q = exact_code((double)b.data[3 * i + c]);
            const double d = (floor(p * 255.0 + 0.5) - floor(q * 255.0 + 0.5)) / 255.0;
            display += (p - q) * (p - q) / (3.0 * N);
            coded += d * d / (3.0 * N);
        }
        exact_lab(lab[0], a.data + 3 * i);
        exact_lab(lab[1], b.data + 3 * i);
        delta_e += ciede2000(lab[0], lab[1]) / N;
    }
    struct relume_difference d, lean;
    CHECK_OK(relume_image_compare(&d, &a, &b, NULL));
    CHECK_NEAR(d.mse, display, 1e-6 * display);
    // a value in 10^4 lies so near the middle of two codes that single precision decides
    CHECK_NEAR(d.psnr_db, -10.0 * log10(coded), 5e-4);
    CHECK_NEAR(d.delta_e, delta_e, 1e-6 * delta_e);
    CHECK_OK(relume_image_compare(&lean, &a, &b,
                                  relume_compare_params(.no_ssim = true, .no_delta_e = true)));
    assert_true(isnan(lean.ssim) && isnan(lean.delta_e));
    CHECK_NEAR(lean.psnr_db, d.psnr_db, 0.0);
    CHECK_NEAR(lean.mse, d.mse, 0.0);
    relume_image_destroy(&a);
    relume_image_destroy(&b);
}

// Every curve through its table, at, beside and beyond its ends.
static void test_encoder(void **state)
{
    (void)state;
    static const struct relume_transfer curves[] = {{.curve = RELUME_CURVE_SRGB},
                                                    {.curve = RELUME_CURVE_AUTO},
                                                    {.curve = RELUME_CURVE_LINEAR},
                                                    {.curve = RELUME_CURVE_GAMMA, .gamma = 1.0f},
                                                    {.curve = RELUME_CURVE_GAMMA, .gamma = 2.2f},
                                                    {.curve = RELUME_CURVE_GAMMA, .gamma = 10.0f},
                                                    {.curve = RELUME_CURVE_GAMMA, .gamma = 0.5f},
                                                    {.curve = RELUME_CURVE_LOG, .gamma = 1e-3f}};
    static struct encoder e;
    for (size_t k = 0; k < sizeof curves / sizeof *curves; k++) {
        encoder_init(&e, curves[k]);
        uint32_t seed = 9;
        for (int i = 0; i < 200000; i++) {
            const float edge[] = {0.0f,           0x1p-9f, 0x1.fffffep-10f, 0.0031308f, 1.0f,
                                  0x1.fffffep-1f, 2.0f,    0x1.fffffep0f,   -0.3f,      7.0f};
            const float v = i < 10 ? edge[i] : (float)pow(10.0, -4.0 * test_uniform(&seed) + 0.3);
            float code;
            encoder_apply(&e, &v, &code, 1);
            const double want = (double)relume_transfer_encode(curves[k], v);
            CHECK_NEAR((double)code, want, 2e-7 * fmax(fabs(want), 1.0));
        }
    }
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
        cmocka_unit_test(test_refusals),       cmocka_unit_test(test_slow_reference),
        cmocka_unit_test(test_encoder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
