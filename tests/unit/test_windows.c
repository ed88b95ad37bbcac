// test_windows.c - components and pictures, compared by lights that are left out
#include "test.h"

#include "capture_fixture.h"
#include "encode/encode/windows.h"
#include "in_folder.h"

enum { LIGHTS = 24, SIDE = 48 };
static const struct fixture f = {
    .width = SIDE, .height = SIDE, .lights = LIGHTS, .views = 1, .hemisphere = true};

static void add_noise(float size)
{
    unsigned n = 1;
    for (int i = 0; i < LIGHTS; i++) {
        struct relume_image image;
        char name[32];
        snprintf(name, sizeof name, "v0-%d.exr", i);
        CHECK_OK(relume_image_load(&image, path_of(name), NULL));
        for (int k = 0; k < 3 * SIDE * SIDE; k++) {
            n = n * 1664525u + 1013904223u;
            image.data[k] += size * ((float)(n >> 8) / 0x1p24f - 0.5f);
        }
        CHECK_OK(relume_image_save(&image, path_of(name), NULL));
        relume_image_destroy(&image);
    }
}

static void compare(double left_out[2], double clearly)
{
    const struct relume_project_params encode = {
        .domain = RELUME_DOMAIN_DISPLAY, .storage = RELUME_STORE_12, .step = RELUME_STEP_COMMON};
    const struct rate_target target = {.psnr_db = 38.0};
    const double header[2] = {0.0, 0.0};
    struct relume_coder_params how = {.coefficients = 6,
                                      .interpolant = relume_interpolant_find("chord")};
    double merit[2];
    relume_capture *capture;
    relume_coder *coder[2];
    CHECK_OK(relume_capture_open(&capture, folder, relume_capture_params(.allow_outside = true)));
    CHECK_OK(relume_coder_learn(&coder[0], &relume_basis_pca, capture, &how, &encode));
    how.coefficients = 0;
    CHECK_OK(relume_coder_learn(&coder[1], &relume_basis_table, capture, &how, &encode));
    CHECK_OK(windows_compare(merit, left_out, (const relume_coder *const *)coder, capture, &target,
                             header, clearly, &encode));
    assert_true(isfinite(merit[0]) && isfinite(merit[1]));
    relume_coder_destroy(&coder[0]);
    relume_coder_destroy(&coder[1]);
    relume_capture_destroy(&capture);
}

// Noise of each photograph is left out of few components, and foretells nothing of the others.
static void test_noise_foretells_nothing(void **state)
{
    double clean[2], noisy[2];
    (void)state;
    fixture_write(&f, folder);
    compare(clean, INFINITY);
    add_noise(0.2f);
    compare(noisy, INFINITY);
    for (int i = 0; i < 2; i++)
        assert_true(clean[i] > noisy[i] && noisy[i] > 10.0 && clean[i] < 60.0);
    assert_true(noisy[0] > noisy[1] + 0.3);
}

// Who is clearly ahead is not asked for more.
static void test_clear(void **state)
{
    double left_out[2];
    (void)state;
    fixture_write(&f, folder);
    compare(left_out, -INFINITY);
    assert_true(left_out[0] == 0.0 && left_out[1] == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_noise_foretells_nothing),
        cmocka_unit_test(test_clear),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
