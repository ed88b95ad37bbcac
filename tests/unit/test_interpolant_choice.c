// test_interpolant_choice.c - what lies between pictures: by what foretells lights left out better
#include "format/coder/coding.h"

#include "test.h"

#include "capture_fixture.h"
#include "in_folder.h"

enum { LIGHTS = 30, SIDE = 24 };
static const struct fixture smooth = {
    .width = SIDE, .height = SIDE, .lights = LIGHTS, .views = 1, .hemisphere = true};

static const char *chosen(struct relume_coder_params *params)
{
    relume_capture *capture;
    CHECK_OK(relume_capture_open(&capture, folder, relume_capture_params(.allow_outside = true)));
    CHECK_OK(relume_coder_between(params, capture, NULL));
    relume_capture_destroy(&capture);
    return params->interpolant->name;
}

// Smooth changes are what a kernel is for; it does not smooth itself, which would be a loss.
static void test_smooth(void **state)
{
    struct relume_coder_params p = {.choose = true};
    (void)state;
    fixture_write(&smooth, folder);
    assert_string_equal(chosen(&p), "chord");
    assert_false(p.choose);
    assert_true(p.parameter[2] == 0.0);
}

// Where a light says nothing of its neighbours, their mean is the best guess: a kernel overshoots.
static void test_noise(void **state)
{
    struct relume_coder_params p = {0};
    struct relume_image image;
    unsigned n = 1;
    (void)state;
    fixture_write(&smooth, folder);
    CHECK_OK(relume_image_create(&image, SIDE, SIDE, 3));
    for (int i = 0; i < LIGHTS; i++) {
        char name[32];
        for (int k = 0; k < 3 * SIDE * SIDE; k++) {
            n = n * 1664525u + 1013904223u;
            image.data[k] = (float)(n >> 8) / 0x1p24f;
        }
        snprintf(name, sizeof name, "v0-%d.exr", i);
        CHECK_OK(relume_image_save(&image, path_of(name), NULL));
    }
    relume_image_destroy(&image);
    assert_string_equal(chosen(&p), "delaunay");
}

// Too few to tell.
static void test_few(void **state)
{
    struct relume_coder_params p = {.parameter = {1.8, 0.7, 0.03, 4.0}};
    struct fixture few = smooth;
    (void)state;
    few.lights = 7;
    fixture_write(&few, folder);
    assert_string_equal(chosen(&p), "delaunay");
    assert_true(p.parameter[0] == 0.0 && p.parameter[3] == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_smooth),
        cmocka_unit_test(test_noise),
        cmocka_unit_test(test_few),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
