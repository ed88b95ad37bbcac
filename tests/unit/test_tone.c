// test_tone.c - tests of include/relume/relight/tone.h: linear light becomes what a screen can
// show: exposure, then a tone operator
#include "test.h"

#include <relume/relight/tone.h>

static void apply(const struct relume_tone *tone, float out[3], float r, float g, float b)
{
    const float rgb[3] = {r, g, b};
    tone->apply(out, rgb, 4);
}

// Grey goes up and never down, from 0 to at most 1, whatever the value.
static void greys_keep_their_order(void **state)
{
    (void)state;
    static const float odd[] = {-1, -INFINITY, INFINITY, NAN, 1e30f, 1e-30f};
    for (int i = 0; relume_tones[i]; i++) {
        float before[3] = {0, 0, 0}, out[3];
        apply(relume_tones[i], out, 0, 0, 0);
        assert_true(out[0] == 0 && out[1] == 0 && out[2] == 0);
        for (double ev = -20; ev < 20; ev += 0.01) {
            const float v = (float)exp2(ev);
            apply(relume_tones[i], out, v, v, v);
            assert_true(out[0] <= 1 && out[1] <= 1 && out[2] <= 1);
            // rounding where a curve is flat: 2^-22
            assert_true(out[0] >= before[0] - 3e-7f);
            memcpy(before, out, sizeof before);
        }
        for (size_t k = 0; k < sizeof odd / sizeof *odd; k++) {
            apply(relume_tones[i], out, odd[k], 0.5f, odd[k]);
            for (int c = 0; c < 3; c++)
                assert_true(out[c] >= 0 && out[c] <= 1);
        }
    }
}

static void known_values(void **state)
{
    (void)state;
    float out[3];
    apply(&relume_tone_linear, out, 0.25f, -3, 7);
    assert_true(out[0] == 0.25f && out[1] == 0 && out[2] == 1);
    // Reinhard et al., Eq. 4: L (1 + L / 16) / (1 + L); the white luminance becomes 1
    apply(&relume_tone_reinhard, out, 1, 1, 1);
    CHECK_NEAR(out[0], 1.0625 / 2, 1e-6);
    apply(&relume_tone_reinhard, out, 4, 4, 4);
    CHECK_NEAR(out[1], 1, 1e-6);
    // a colour keeps its proportions: luminance of (2, 1, 0) is 1.1404
    apply(&relume_tone_reinhard, out, 2, 1, 0);
    CHECK_NEAR(out[0], fmin(2 * (1 + 1.1404 / 16) / 2.1404, 1), 1e-6);
    CHECK_NEAR(out[1], (1 + 1.1404 / 16) / 2.1404, 1e-6);
    assert_true(out[2] == 0);
    // Narkowicz: x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14)
    apply(&relume_tone_filmic, out, 1, 0.18f, 0);
    CHECK_NEAR(out[0], 2.54 / 3.16, 1e-6);
    CHECK_NEAR(out[1], 0.18 * (2.51 * 0.18 + 0.03) / (0.18 * (2.43 * 0.18 + 0.59) + 0.14), 1e-6);
    // shown through the sRGB curve, a half is 0.5^(1 / 2.2) of the screen's code, and a dark value
    // 1e-5 is 12.92 times what is coded
    apply(&relume_tone_gamma, out, 0.5f, 1e-5f, 2);
    CHECK_NEAR(1.055 * pow((double)out[0], 1 / 2.4) - 0.055, pow(0.5, 1 / 2.2), 1e-6);
    CHECK_NEAR(12.92 * (double)out[1], pow(1e-5, 1 / 2.2), 1e-6);
    assert_true(out[2] == 1);
}

static void images_are_exposed_first(void **state)
{
    (void)state;
    struct relume_image image, grey;
    CHECK_OK(relume_image_create(&image, 2, 1, 3));
    CHECK_OK(relume_image_create(&grey, 2, 1, 1));
    for (int i = 0; i < 6; i++)
        image.data[i] = 0.1f;
    CHECK_OK(relume_tone_apply(&image, relume_tone_params(.exposure_ev = 2)));
    for (int i = 0; i < 6; i++)
        CHECK_NEAR(image.data[i], 0.4, 1e-7);
    CHECK_OK(relume_tone_apply(
        &image, relume_tone_params(.tone = &relume_tone_reinhard, .exposure_ev = 1, .white = 2)));
    CHECK_NEAR(image.data[0], 0.8 * (1 + 0.8 / 4) / 1.8, 1e-6);
    assert_int_equal(relume_tone_apply(&grey, NULL), RELUME_EINVAL);
    assert_int_equal(relume_tone_apply(&image, relume_tone_params(.white = -1)), RELUME_EINVAL);
    relume_image_destroy(&image);
    relume_image_destroy(&grey);
}

// ---------------------------------------------------------------- meter

static void fill(struct relume_image *image, int from, int to, double value)
{
    for (int i = 3 * from; i < 3 * to; i++)
        image->data[i] = (float)value;
}

// Luminances are counted in steps of 1/16 EV.
static const double step_ev = 1.0 / 16;

static void bright_parts_come_to_nine_tenths(void **state)
{
    (void)state;
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, 50, 20, 3));
    assert_true(relume_tone_meter_bright(&image) == 0);
    for (int ev = -10; ev <= 10; ev++) {
        fill(&image, 0, 1000, 0.9 * exp2(ev));
        CHECK_NEAR(relume_tone_meter_bright(&image), -ev, step_ev);
    }
    fill(&image, 0, 1000, 0);
    fill(&image, 0, 200, 0.225);  // the rest is black and does not count
    CHECK_NEAR(relume_tone_meter_bright(&image), 2, step_ev);
    fill(&image, 0, 1, 50);  // a glint
    CHECK_NEAR(relume_tone_meter_bright(&image), 2, step_ev);
    image.data[0] = image.data[1] = 0;  // the largest channel counts
    image.data[2] = 0.225f;
    CHECK_NEAR(relume_tone_meter_bright(&image), 2, step_ev);
    assert_true(relume_tone_meter_for(&image, NULL) == relume_tone_meter_bright(&image));
    assert_true(relume_tone_meter_for(&image, &relume_tone_filmic) == relume_tone_meter(&image));
    relume_image_destroy(&image);
}

static void mid_grey_needs_no_exposure(void **state)
{
    (void)state;
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, 50, 20, 3));
    assert_true(relume_tone_meter(&image) == 0);
    for (int ev = -10; ev <= 10; ev++) {
        fill(&image, 0, 1000, 0.18 * exp2(ev));
        CHECK_NEAR(relume_tone_meter(&image), -ev, step_ev);
    }
    fill(&image, 0, 1000, 1e-9);
    CHECK_NEAR(relume_tone_meter(&image), 16, 0);
    relume_image_destroy(&image);
}

static void a_sun_and_a_black_room_do_not_matter(void **state)
{
    (void)state;
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, 50, 20, 3));
    fill(&image, 0, 500, 0.36);
    CHECK_NEAR(relume_tone_meter(&image), -1, step_ev);  // half of it is black
    fill(&image, 0, 9, 1e5);
    CHECK_NEAR(relume_tone_meter(&image), -1, step_ev);  // a sun in two hundredths of the rest
    fill(&image, 500, 540, 0.001);
    CHECK_NEAR(relume_tone_meter(&image), -1, step_ev);  // less than a tenth is dark
    fill(&image, 600, 610, NAN);
    image.data[3 * 620] = -1;
    CHECK_NEAR(relume_tone_meter(&image), -1, step_ev);
    relume_image_destroy(&image);
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// By sorting: the mean logarithm of what is left of the sorted luminances.
static void the_meter_is_a_trimmed_log_average(void **state)
{
    (void)state;
    enum { N = 4000 };
    static double logs[N];
    struct relume_image image;
    uint32_t random = 3;
    CHECK_OK(relume_image_create(&image, N / 10, 10, 3));
    for (int i = 0; i < N; i++) {
        const double v = exp2(10 * test_uniform(&random) * test_uniform(&random) - 6);
        for (int c = 0; c < 3; c++)
            image.data[3 * i + c] = (float)(v * (0.5 + test_uniform(&random)));
        const float *p = &image.data[3 * i];
        logs[i] = log2(0.2126 * (double)p[0] + 0.7152 * (double)p[1] + 0.0722 * (double)p[2]);
    }
    qsort(logs, N, sizeof *logs, compare);
    double sum = 0;
    for (int i = N / 10; i < N - N / 50; i++)
        sum += logs[i];
    const double want = log2(0.18) - sum / (N - N / 10 - N / 50);
    CHECK_NEAR(relume_tone_meter(&image), want, 0.5 * step_ev);
    relume_image_destroy(&image);
}

// A background that should be black is, under a sky, what is left of 8 bits: not quite 0.
static void the_meter_sees_no_background(void **state)
{
    (void)state;
    enum { PIXELS = 1000 };
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, PIXELS / 10, 10, 3));
    for (int i = 0; i < 3 * PIXELS; i++)
        image.data[i] = i / 3 < 3 * PIXELS / 4 ? 0.02f : 80.0f;
    CHECK_NEAR(relume_tone_meter(&image), log2(0.18 / 80), step_ev);
    relume_image_destroy(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(greys_keep_their_order),
        cmocka_unit_test(known_values),
        cmocka_unit_test(images_are_exposed_first),
        cmocka_unit_test(bright_parts_come_to_nine_tenths),
        cmocka_unit_test(mid_grey_needs_no_exposure),
        cmocka_unit_test(a_sun_and_a_black_room_do_not_matter),
        cmocka_unit_test(the_meter_is_a_trimmed_log_average),
        cmocka_unit_test(the_meter_sees_no_background),
    };
    return cmocka_run_group_tests_name("tone", tests, NULL, NULL);
}
