// Photographs: what EXIF and ICC profiles say, turning, grouping, white balance and fall-off
#include "test.h"

#include "made_camera.h"
#include "made_dng.h"
#include "made_exif.h"

#include <lcms2.h>

// AdobeRGB: other primaries, gamma 563/256.
static void make_profile(struct exif_bytes *s)
{
    const cmsCIExyY white = {0.3127, 0.3290, 1.0};
    const cmsCIExyYTRIPLE primaries = {{0.64, 0.33, 1.0}, {0.21, 0.71, 1.0}, {0.15, 0.06, 1.0}};
    cmsToneCurve *gamma = cmsBuildGamma(NULL, 563.0 / 256.0), *curves[3] = {gamma, gamma, gamma};
    cmsHPROFILE h = cmsCreateRGBProfile(&white, &primaries, curves);
    cmsUInt32Number size;
    *s = (struct exif_bytes){.b = "ICC_PROFILE\0\1\1", .n = 14};
    assert_true(cmsSaveProfileToMem(h, NULL, &size) && size < sizeof s->b - 14);
    assert_true(cmsSaveProfileToMem(h, s->b + 14, &size));
    s->n += size;
    cmsCloseProfile(h);
    cmsFreeToneCurve(gamma);
}

// 32 x 16 pixels: left red, right green, and a blue quarter at the lower left.
static void write_jpeg(const char *path)
{
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, 32, 16, 3));
    for (int y = 0; y < 16; y++)
        for (int x = 0; x < 32; x++)
            image.data[3 * (32 * y + x) + (x >= 16 ? 1 : y < 8 ? 0 : 2)] = 0.5f;
    CHECK_OK(relume_image_save(&image, path, NULL));
    relume_image_destroy(&image);
}

static int colour_at(const struct relume_image *image, int x, int y)
{
    const float *p = image->data + 3 * (y * image->width + x);
    return p[0] > p[1] && p[0] > p[2] ? 0 : p[1] > p[2] ? 1 : 2;
}

static void test_notes_and_turning(void **state)
{
    (void)state;
    char folder[64], path[96];
    struct exif_bytes exif;
    snprintf(path, sizeof path, "%s/a.jpg", test_folder(folder));
    // what the upper left, upper right, lower left and lower right show after turning (EXIF 2.3)
    static const char *const shown[] = {"RGBG", "GRGB", "GBGR", "BGRG",
                                        "RBGG", "BRGG", "GGBR", "GGRB"};
    for (int orientation = 1; orientation <= 8; orientation++) {
        struct relume_image image;
        struct relume_exif notes, read;
        write_jpeg(path);
        exif_make(&exif, orientation);
        exif_insert(path, 0xe1, &exif);
        CHECK_OK(relume_photograph_load(&image, &notes, path, NULL));
        CHECK_OK(relume_exif_read(&read, path, NULL));
        assert_memory_equal(&notes, &read, sizeof notes);
        CHECK_NEAR(notes.time_s, 0.02, 1e-7);
        CHECK_NEAR(notes.f_number, 2.8, 1e-6);
        CHECK_NEAR(notes.iso, 400.0, 0.0);
        assert_int_equal(notes.taken_s, 1614834367);  // date -u -d '2021-03-04 05:06:07' +%s
        CHECK_NEAR(relume_exif_exposure(&notes), 0.02 * 4.0 / 2.8 / 2.8, 1e-7);
        assert_int_equal(notes.orientation, orientation);
        assert_int_equal(image.width, orientation > 4 ? 16 : 32);
        assert_int_equal(notes.width, image.width);
        assert_int_equal(notes.height, image.height);
        for (int k = 0; k < 4; k++)
            assert_int_equal(
                "RGB"[colour_at(&image, k % 2 ? image.width - 3 : 2, k / 2 ? image.height - 3 : 2)],
                shown[orientation - 1][k]);
        relume_image_destroy(&image);
    }
    test_folder_remove(folder);
}

// AdobeRGB (0.5, 0.5, 0.5) is grey 0.5^(563/256); its pure green is outside of sRGB: red below 0.
static void test_profile(void **state)
{
    (void)state;
    char folder[64], path[96];
    struct exif_bytes *icc = calloc(1, sizeof *icc);
    struct relume_image image, codes, grey;
    struct relume_exif notes;
    snprintf(path, sizeof path, "%s/a.jpg", test_folder(folder));
    CHECK_OK(relume_image_create(&grey, 16, 16, 3));
    for (int i = 0; i < 3 * 16 * 16; i++)
        grey.data[i] = relume_transfer_decode((struct relume_transfer){.curve = RELUME_CURVE_SRGB},
                                              128.0f / 255.0f);
    CHECK_OK(relume_image_save(&grey, path, NULL));
    make_profile(icc);
    exif_insert(path, 0xe2, icc);
    CHECK_OK(relume_photograph_load(&image, &notes, path, NULL));
    assert_true(notes.profile);
    for (int c = 0; c < 3; c++)  // white points agree to the 16 bits of ICC numbers
        CHECK_NEAR(image.data[c], pow(128.0 / 255.0, 563.0 / 256.0), 1e-3);
    // IEC 61966-2-5 to sRGB: the first column is (1.398, 0, 0), the second (-0.398, 1, -0.043)
    CHECK_NEAR(notes.to_srgb[0], 1.398, 2e-3);
    CHECK_NEAR(notes.to_srgb[1], -0.398, 2e-3);
    CHECK_NEAR(notes.to_srgb[7], -0.043, 2e-3);
    CHECK_OK(relume_photograph_load(&codes, NULL, path, relume_photograph_params(.codes = true)));
    CHECK_NEAR(codes.data[0], 128.0 / 255.0, 1e-6);
    relume_image_destroy(&grey);
    relume_image_destroy(&image);
    relume_image_destroy(&codes);
    free(icc);
    test_folder_remove(folder);
}

static void test_bad_files(void **state)
{
    (void)state;
    char folder[64], path[96];
    struct test_log log;
    struct relume_image image;
    test_log_init(&log);
    test_folder(folder);
    const struct relume_photograph_params *p = relume_photograph_params(.log = &log.log);
    snprintf(path, sizeof path, "%s/a.dng", folder);
    test_write(path, "not a RAW file", 14);
    assert_int_equal(relume_photograph_load(&image, NULL, path, p), RELUME_EUNSUPPORTED);
    assert_non_null(strstr(log.text, "RAW"));
    snprintf(path, sizeof path, "%s/a.exr", folder);
    CHECK_OK(relume_image_create(&image, 4, 4, 3));
    image.data[7] = NAN;
    CHECK_OK(relume_image_save(&image, path, NULL));
    relume_image_destroy(&image);
    assert_int_equal(relume_photograph_load(&image, NULL, path, p), RELUME_EDAMAGED);
    assert_non_null(strstr(log.text, "NaN"));
    assert_null(image.data);
    assert_int_equal(relume_photograph_load(&image, NULL, "nowhere.jpg", p), RELUME_ENOTFOUND);
    test_folder_remove(folder);
}

static void test_groups(void **state)
{
    (void)state;
    // three brackets: after a pause, and by an exposure that comes again; given in disorder
    static const double time_s[9] = {1, 0.25, 4, 1, 0.25, 4, 1, 0.25, 4};
    static const int64_t taken_s[9] = {0, 1, 5, 100, 101, 105, 110, 111, 115};
    static const int disorder[9] = {4, 0, 8, 2, 6, 1, 3, 7, 5};
    struct relume_exif notes[9];
    int group[9];
    memset(notes, 0, sizeof notes);
    for (int i = 0; i < 9; i++)
        notes[i] = (struct relume_exif){.width = 10,
                                        .height = 10,
                                        .time_s = time_s[disorder[i]],
                                        .taken_s = 1000000 + taken_s[disorder[i]]};
    assert_int_equal(relume_exif_brackets(group, notes, 9, 0.0), 3);
    for (int i = 0; i < 9; i++)
        assert_int_equal(group[i], disorder[i] / 3);
    for (int i = 0; i < 9; i++)  // no clock: the order of the list
        notes[i] = (struct relume_exif){.time_s = time_s[i]};
    assert_int_equal(relume_exif_brackets(group, notes, 9, 0.0), 3);
    notes[4].width = 11;  // another camera in between
    assert_int_equal(relume_exif_brackets(group, notes, 9, 0.0), 5);
}

static void test_white(void **state)
{
    (void)state;
    struct relume_image image;
    float gain[3];
    CHECK_OK(relume_image_create(&image, 8, 8, 3));
    for (int i = 0; i < 64; i++)
        for (int c = 0; c < 3; c++)
            image.data[3 * i + c] = (i % 8 < 4 ? 0.1f : 0.9f) * (float)(c + 1) / 3.0f;
    CHECK_OK(relume_white_measure(gain, &image, 0, 0, 4, 8, NULL));
    relume_white_apply(&image, gain);
    // BT.709 luminance of (1, 2, 3) / 30
    const double grey = (0.2126 + 2 * 0.7152 + 3 * 0.0722) / 30;
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(image.data[c], grey, 1e-6);
    assert_int_equal(relume_white_measure(gain, &image, 4, 4, 5, 2, NULL), RELUME_EINVAL);
    for (int i = 0; i < 3 * 64; i++)
        image.data[i] = 1.0f;
    assert_int_equal(relume_white_measure(gain, &image, 0, 0, 8, 8, NULL), RELUME_EUNFIT);
    for (int i = 0; i < 3 * 64; i++)
        image.data[i] = 0.0f;
    assert_int_equal(relume_white_measure(gain, &image, 0, 0, 8, 8, NULL), RELUME_EUNFIT);
    relume_image_destroy(&image);
}

// The made camera's vignetting is 1 - k r^2 exactly.
static void test_falloff(void **state)
{
    (void)state;
    const struct made_shot s = {.vignetting = 0.4};
    struct relume_image flat, even, image;
    struct relume_falloff f;
    CHECK_OK(relume_image_create(&flat, 96, 64, 3));
    CHECK_OK(relume_image_create(&image, 96, 64, 3));
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 96; x++)
            for (int c = 0; c < 3; c++)
                flat.data[3 * (96 * y + x) + c] =
                    (float)(0.5 * made_vignette(&s, 96, 64, x + 0.5, y + 0.5));
    memcpy(image.data, flat.data, sizeof(float) * 3 * 96 * 64);
    CHECK_OK(relume_falloff_fit(&f, &flat, NULL));
    CHECK_NEAR(f.k[0], -0.4, 1e-3);
    CHECK_NEAR(f.k[1], 0.0, 3e-3);
    relume_falloff_divide(&image, &f);
    for (int i = 0; i < 3 * 96 * 64; i++)
        CHECK_NEAR(image.data[i], 0.5, 1e-3);
    memcpy(image.data, flat.data, sizeof(float) * 3 * 96 * 64);
    CHECK_OK(relume_flat_divide(&image, &flat, NULL));
    for (int i = 1; i < 96 * 64; i++)  // even, smoothing is narrow here
        CHECK_NEAR(image.data[3 * i], image.data[0], 2e-3);
    CHECK_OK(relume_image_create(&even, 95, 64, 3));
    assert_int_equal(relume_flat_divide(&image, &even, NULL), RELUME_EINVAL);
    assert_int_equal(relume_falloff_fit(&f, &even, NULL), RELUME_EUNFIT);  // black
    relume_image_destroy(&flat);
    relume_image_destroy(&even);
    relume_image_destroy(&image);
}

// RAW comes out linear, whatever its brightness: exposures of a bracket keep their ratios. Codes of
// 4031 steps; the camera's matrix is rounded to 1e-4.
static void test_raw(void **state)
{
    (void)state;
    char folder[64], path[96];
    struct relume_image image;
    struct relume_exif notes;
    struct test_log log;
    snprintf(path, sizeof path, "%s/a.dng", test_folder(folder));
    for (int k = 1; k <= 3; k++) {
        test_log_init(&log);
        dng_write(path, 0.3 * k, 0);
        const relume_status status =
            relume_photograph_load(&image, &notes, path, relume_photograph_params(.log = &log.log));
        if (status && strstr(log.text, "cannot read; expected a build with LibRaw")) {
            test_folder_remove(folder);
            print_message("skipped: the installed OpenImageIO reads no RAW\n");
            skip();
        }
        assert_int_equal(status, RELUME_OK);
        assert_true(notes.linear && image.width == DNG_SIDE && image.height == DNG_SIDE);
        CHECK_NEAR(notes.time_s, 0.02, 1e-7);
        for (int step = 0; step < 8; step++)  // in the middle of a step, away from what borders it
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(image.data[3 * (32 * DNG_SIDE + 8 * step + 4) + c],
                           0.3 * k * (step + 0.5) / 8.0, 1e-3);
        relume_image_destroy(&image);
    }
    test_log_init(&log);
    dng_write(path, 0.5, 100);
    assert_int_equal(
        relume_photograph_load(&image, &notes, path, relume_photograph_params(.log = &log.log)),
        RELUME_EUNSUPPORTED);
    assert_non_null(strstr(log.text, "a.dng"));
    test_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_raw),     cmocka_unit_test(test_notes_and_turning),
        cmocka_unit_test(test_profile), cmocka_unit_test(test_bad_files),
        cmocka_unit_test(test_groups),  cmocka_unit_test(test_white),
        cmocka_unit_test(test_falloff),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
