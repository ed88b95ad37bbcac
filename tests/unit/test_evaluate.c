// test_evaluate.c - tests of include/relume/evaluate.h: how well a file shows a capture: relit with
// every light, compared with every image
#include "test.h"

#include "capture_fixture.h"

static char folder[64], pack_path[96];

static int setup(void **state)
{
    (void)state;
    const struct fixture f = {
        .width = 17, .height = 13, .lights = 7, .views = 2, .hemisphere = true, .mask = true};
    test_folder(folder);
    fixture_write(&f, folder);
    snprintf(pack_path, sizeof pack_path, "%s/pack.exr", folder);
    return fixture_encode(folder, pack_path, &relume_basis_sh, 4, NULL) != RELUME_OK;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

// Against the pictures compared one by one.
static void test_fields(void **state)
{
    (void)state;
    relume_pack *pack;
    relume_capture *capture;
    struct relume_evaluation e;
    CHECK_OK(relume_pack_open(&pack, pack_path, NULL));
    CHECK_OK(relume_capture_open(&capture, folder, NULL));
    CHECK_OK(relume_evaluate(&e, pack, capture, NULL));
    double square = 0.0, psnr = 0.0, mse = 0.0, ssim = 0.0, delta_e = 0.0, third = 0.0;
    for (int view = 0; view < 2; view++)
        for (int light = 0; light < 7; light++) {
            const struct relume_light lamp = {
                .direction = relume_capture_manifest(capture)->directions[light],
                .rgb = {1.0f, 1.0f, 1.0f}};
            const struct relume_camera camera = {.framing = RELUME_FRAME_VIEW, .view = view};
            struct relume_image relit, captured, mask;
            struct relume_difference d;
            CHECK_OK(relume_frame(&relit, pack, &camera, &lamp, 1, NULL));
            CHECK_OK(relume_capture_image(&captured, capture, view, light, NULL));
            CHECK_OK(relume_capture_mask(&mask, capture, view, NULL));
            CHECK_OK(
                relume_image_compare(&d, &relit, &captured, relume_compare_params(.mask = &mask)));
            square += d.rms * d.rms / 14;
            psnr += d.psnr_db / 14;
            mse += d.mse / 14;
            ssim += d.ssim / 14;
            delta_e += d.delta_e / 14;
            third += light == 3 ? d.psnr_db / 2 : 0.0;
            relume_image_destroy(&relit);
            relume_image_destroy(&captured);
            relume_image_destroy(&mask);
        }
    assert_int_equal(e.images, 14);
    assert_int_equal(e.views, 2);
    assert_int_equal(e.lights, 7);
    CHECK_NEAR(e.rms, sqrt(square), 1e-12);
    CHECK_NEAR(e.psnr_db, psnr, 1e-9);
    CHECK_NEAR(e.psnr_pooled_db, -10.0 * log10(mse), 1e-9);
    CHECK_NEAR(e.ssim, ssim, 1e-9);
    CHECK_NEAR(e.delta_e, delta_e, 1e-9);
    CHECK_NEAR(e.light[3].psnr_db, third, 1e-9);
    CHECK_NEAR(e.raw_bytes, 2.0 * 7 * 17 * 13 * 12, 0.0);
    CHECK_NEAR(e.ratio, e.raw_bytes / e.file_bytes, 1e-9);
    relume_evaluation_destroy(&e);
    assert_null(e.light);
    relume_capture_destroy(&capture);
    relume_pack_destroy(&pack);
}

// An image that breaks after opening is named; one of another size is refused before any work.
static void test_refusals(void **state)
{
    (void)state;
    relume_pack *pack;
    relume_capture *capture;
    struct relume_evaluation e;
    struct test_log log;
    char path[128], kept[128], small[64];
    test_log_init(&log);
    CHECK_OK(relume_pack_open(&pack, pack_path, NULL));
    CHECK_OK(relume_capture_open(&capture, folder, NULL));
    snprintf(path, sizeof path, "%s/v1-5.exr", folder);
    snprintf(kept, sizeof kept, "%s/kept", folder);
    assert_int_equal(rename(path, kept), 0);
    test_write(path, "x", 1);
    assert_int_equal(relume_evaluate(&e, pack, capture, relume_evaluate_params(.log = &log.log)),
                     RELUME_EFORMAT);
    assert_non_null(strstr(log.text, "v1-5.exr"));
    assert_int_equal(log.lines, 1);
    assert_null(e.light);
    assert_int_equal(rename(kept, path), 0);
    relume_capture_destroy(&capture);

    const struct fixture f = {.width = 8, .height = 8, .lights = 4, .views = 2};
    test_folder(small);
    fixture_write(&f, small);
    CHECK_OK(relume_capture_open(&capture, small, NULL));
    assert_int_equal(relume_evaluate(&e, pack, capture,
                                     relume_evaluate_params(.log = &log.log, .capture = "small")),
                     RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "small: 8 x 8"));
    relume_capture_destroy(&capture);
    relume_pack_destroy(&pack);
    test_folder_remove(small);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_fields),
                                       cmocka_unit_test(test_refusals)};
    return cmocka_run_group_tests(tests, setup, teardown);
}
