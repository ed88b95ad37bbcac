// Loops of patterns: those of the eye where nothing fades, no seam, no light lost.
#include "relight/eye/pattern.h"

#include "test.h"

#include <relume/relight/psf.h>

static const double luminance = 3.0, fps = 20.0, seconds = 1.0, fade = 0.25;

static const struct relume_psf_params *small(void)
{
    static const struct relume_psf_params p = {.size = 64, .width_mm = 4.0, .wavelengths = 4};
    return &p;
}

static void make(relume_eye **eye, relume_psf **psf)
{
    CHECK_OK(relume_eye_create(eye, NULL, luminance));
    CHECK_OK(relume_eye_advance(*eye, 1.0, luminance));
    CHECK_OK(relume_psf_create(psf, small()));
}

static relume_psf_cycle *make_cycle(void)
{
    relume_eye *eye;
    relume_psf *psf;
    relume_psf_cycle *cycle;
    make(&eye, &psf);
    CHECK_OK(
        relume_psf_cycle_create(&cycle, psf, eye,
                                relume_psf_cycle_params(.seconds = seconds, .fps = fps,
                                                        .fade_s = fade, .luminance = luminance)));
    relume_psf_destroy(&psf);
    relume_eye_destroy(&eye);
    return cycle;
}

// Sum of absolute differences of the green of two patterns, each of which sums to 1.
static double apart(const relume_psf *psf, const struct relume_image *other)
{
    struct relume_image now;
    double sum = 0.0;
    CHECK_OK(relume_psf_image(&now, psf));
    for (size_t i = 0; i < (size_t)now.width * (size_t)now.height; i++)
        sum += fabs((double)now.data[3 * i + 1] - (double)other->data[3 * i + 1]);
    relume_image_destroy(&now);
    return sum;
}

static void test_of_the_eye(void **state)
{
    (void)state;
    relume_psf_cycle *cycle = make_cycle();
    relume_eye *eye;
    relume_psf *psf, *shown;
    make(&eye, &psf);
    CHECK_OK(relume_psf_create(&shown, small()));
    for (int k = 0; k < (int)(seconds * fps); k++) {
        struct relume_image true_one;
        CHECK_OK(relume_psf_update(psf, eye));
        CHECK_OK(relume_psf_image(&true_one, psf));
        CHECK_OK(relume_psf_cycle_show(shown, cycle, k / fps + 3.0 * seconds + 1e-9));
        if (k / fps >= fade) {
            // halfs: 2^-12 of each value
            assert_true(apart(shown, &true_one) < 3e-4);
            CHECK_NEAR(relume_psf_light(shown), relume_psf_light(psf), 1e-6);
        }
        relume_image_destroy(&true_one);
        CHECK_OK(relume_eye_advance(eye, 1.0 / fps, luminance));
    }
    relume_psf_destroy(&shown);
    relume_psf_destroy(&psf);
    relume_eye_destroy(&eye);
    relume_psf_cycle_destroy(&cycle);
}

// The step over the loop's end is one that the eye makes: its first pattern is the one that the eye
// shows a whole loop later.
static void test_has_no_seam(void **state)
{
    (void)state;
    relume_psf_cycle *cycle = make_cycle();
    relume_eye *eye;
    relume_psf *psf;
    struct relume_image later;
    make(&eye, &psf);
    for (int k = 0; k < (int)(seconds * fps); k++)
        CHECK_OK(relume_eye_advance(eye, 1.0 / fps, luminance));
    CHECK_OK(relume_psf_update(psf, eye));
    CHECK_OK(relume_psf_image(&later, psf));
    CHECK_OK(relume_psf_cycle_show(psf, cycle, 0.0));
    assert_true(apart(psf, &later) < 3e-4);
    CHECK_OK(relume_psf_cycle_show(psf, cycle, -seconds));
    assert_true(apart(psf, &later) < 3e-4);
    relume_image_destroy(&later);
    relume_psf_destroy(&psf);
    relume_eye_destroy(&eye);
    relume_psf_cycle_destroy(&cycle);
}

static void test_keeps_the_light(void **state)
{
    (void)state;
    relume_psf_cycle *cycle = make_cycle();
    relume_psf *psf;
    CHECK_OK(relume_psf_create(&psf, small()));
    for (double t = -0.37; t < 1.5; t += 0.11) {
        struct relume_image image;
        CHECK_OK(relume_psf_cycle_show(psf, cycle, t));
        CHECK_OK(relume_psf_image(&image, psf));
        for (int c = 0; c < 3; c++) {
            double sum = 0.0;
            for (size_t i = 0; i < (size_t)image.width * (size_t)image.height; i++)
                sum += (double)image.data[3 * i + (size_t)c];
            CHECK_NEAR(sum, 1.0, 1e-5);  // floats, some thousand of them
        }
        relume_image_destroy(&image);
    }
    relume_psf_destroy(&psf);
    relume_psf_cycle_destroy(&cycle);
}

static void test_wrong(void **state)
{
    (void)state;
    relume_psf_cycle *cycle = make_cycle(), *none;
    relume_eye *eye;
    relume_psf *psf, *larger;
    make(&eye, &psf);
    CHECK_OK(relume_psf_create(&larger, relume_psf_params(.size = 96, .wavelengths = 4)));
    assert_int_equal(relume_psf_cycle_show(larger, cycle, 0.0), RELUME_EINVAL);
    assert_int_equal(relume_psf_cycle_show(psf, cycle, NAN), RELUME_EINVAL);
    const struct relume_psf_cycle_params wrong[] = {
        {.seconds = -1.0}, {.seconds = NAN},           {.seconds = 1e9},
        {.fps = -1.0},     {.seconds = 1, .fps = 0.1}, {.seconds = 1.0, .fade_s = 2.0},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(relume_psf_cycle_create(&none, psf, eye, &wrong[i]), RELUME_EINVAL);
        assert_null(none);
    }
    relume_psf_destroy(&larger);
    relume_psf_destroy(&psf);
    relume_eye_destroy(&eye);
    relume_psf_cycle_destroy(&cycle);
    relume_psf_cycle_destroy(&cycle);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_of_the_eye),
        cmocka_unit_test(test_has_no_seam),
        cmocka_unit_test(test_keeps_the_light),
        cmocka_unit_test(test_wrong),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
