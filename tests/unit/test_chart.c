// Colour targets: found wherever they lie, their camera's matrix recovered, other pictures refused
#include "capture/acquire/chart.h"

#include "test.h"

#include "made_chart.h"

// A camera under warm light: what it sees of linear sRGB.
#define CAMERA                                                                                     \
    {                                                                                              \
        {0.80, 0.25, 0.05}, {0.12, 0.62, 0.10},                                                    \
        {                                                                                          \
            0.02, 0.10, 0.38                                                                       \
        }                                                                                          \
    }

static const struct made_chart plain = {
    .x = 330, .y = 240, .pitch = 50, .camera = CAMERA, .seed = 1};

// The matrix and the camera together leave colours as they are, but for the exposure.
static void check_matrix(const struct relume_chart *t, const struct made_chart *from, double tol)
{
    double colour[RELUME_CHART_PATCHES][3];
    relume_chart_colours(colour, NULL);
    for (int i = 0; i < RELUME_CHART_PATCHES; i++)
        for (int c = 0; c < 3; c++) {
            double shown = 0.0;
            for (int k = 0; k < 3; k++) {
                double seen = 0.0;
                for (int j = 0; j < 3; j++)
                    seen += from->camera[k][j] * colour[i][j];
                shown += t->exposure * (double)t->matrix[3 * c + k] * seen;
            }
            CHECK_NEAR(shown, colour[i][c], tol);
        }
}

// Corners within `pixels` of where they lie.
static void check_corners(const struct relume_chart *t, const struct made_chart *from,
                          double pixels)
{
    static const double at[4][2] = {{-0.44, -0.44}, {5.44, -0.44}, {5.44, 3.44}, {-0.44, 3.44}};
    for (int i = 0; i < 4; i++) {
        double place[2];
        made_chart_place(place, from, at[i][0], at[i][1]);
        CHECK_NEAR(t->corner[i][0], place[0], pixels);
        CHECK_NEAR(t->corner[i][1], place[1], pixels);
    }
}

static void find(struct relume_chart *t, const struct made_chart *from, int w, int h)
{
    struct relume_image image;
    struct test_log log;
    test_log_init(&log);
    CHECK_OK(made_chart(&image, w, h, from));
    const relume_status status =
        relume_chart_measure(t, &image, "made", relume_chart_params(.log = &log.log));
    if (status)
        print_error("turn %g: %s\n", from->turn_deg, log.text);
    CHECK_OK(status);
    relume_image_destroy(&image);
}

static void test_exact(void **state)
{
    struct relume_chart t;
    (void)state;
    find(&t, &plain, 660, 480);
    check_corners(&t, &plain, 0.6);
    check_matrix(&t, &plain, 2e-4);  // floats, and the fit's steps
    assert_int_equal(t.used, 24);
    assert_true(t.after[1] < 0.1 && t.balanced[0] > 3.0 && t.before[0] > 10.0);
    assert_true(t.before[0] > t.balanced[0] && t.uneven < 0.002);
    // greys keep their luminance
    const struct relume_chart_patch *grey = &t.patch[20];
    double y = 0.0, shown = 0.0;
    static const double lum[3] = {0.2126, 0.7152, 0.0722};
    for (int c = 0; c < 3; c++) {
        y += lum[c] * (double)grey->found[c];
        for (int k = 0; k < 3; k++)
            shown += lum[c] * (double)t.matrix[3 * c + k] * (double)grey->found[k];
    }
    CHECK_NEAR(shown / y, 1.0, 0.005);
}

static void test_anywhere(void **state)
{
    static const double turns[] = {0, 13, 147, 270};
    (void)state;
    for (size_t i = 0; i < sizeof turns / sizeof *turns; i++) {
        struct relume_chart t;
        struct made_chart from = plain;
        from.turn_deg = turns[i];
        from.tilt = i % 2 ? 0.05 : -0.03;
        from.pitch = i % 3 == 0 ? 24 : 37;
        from.x = 340, from.y = 300;
        from.clutter = true;
        from.noise = 0.01;
        from.vignette = 0.4;
        from.slope = 0.15;
        from.seed = (unsigned)i;
        find(&t, &from, 700, 600);
        check_corners(&t, &from, 1.5);
        assert_true(t.after[0] < 1.0 && t.after[1] < 4.0);
        check_matrix(&t, &from, 0.03);  // noise of 1 % in dark, small patches; light not flat
    }
}

static void test_corners(void **state)
{
    static const double at[4][2] = {{-0.44, -0.44}, {5.44, -0.44}, {5.44, 3.44}, {-0.44, 3.44}};
    struct relume_image image;
    struct made_chart from = plain;
    (void)state;
    from.turn_deg = 20;
    CHECK_OK(made_chart(&image, 660, 480, &from));
    for (int order = 0; order < 8; order++) {
        double corner[4][2];
        struct relume_chart t;
        for (int i = 0; i < 4; i++) {
            const int k = (order < 4 ? order + i : order - i) & 3;
            made_chart_place(corner[i], &from, at[k][0], at[k][1]);
        }
        CHECK_OK(relume_chart_measure(&t, &image, "made",
                                      relume_chart_params(.corner = (const double(*)[2])corner)));
        check_corners(&t, &from, 1e-6);
        check_matrix(&t, &from, 2e-4);
    }
    relume_image_destroy(&image);
}

// Overexposed patches are left out, and the matrix is still right.
static void test_clipped(void **state)
{
    struct relume_image image;
    struct relume_chart t;
    struct made_chart from = plain;
    (void)state;
    for (int c = 0; c < 9; c++)
        from.camera[c / 3][c % 3] *= 1.3;
    CHECK_OK(made_chart(&image, 660, 480, &from));
    for (int i = 0; i < 3 * 660 * 480; i++)
        image.data[i] = fminf(image.data[i], 1.0f);
    CHECK_OK(relume_chart_measure(&t, &image, "made", relume_chart_params(.ends_at_1 = true)));
    assert_true(t.used < 24 && t.used >= 20 && !t.patch[18].used && t.patch[20].used);
    check_matrix(&t, &from, 2e-4);
    // where all is lost the result is grey
    float *p = image.data;
    p[0] = p[1] = p[2] = 1.0f;
    p[3] = 0.2f, p[4] = 0.3f, p[5] = 0.1f;
    relume_chart_apply(&image, t.matrix, true);
    assert_true(p[0] == p[1] && p[1] == p[2] && p[0] >= 1.0f);
    CHECK_NEAR((double)p[3], 0.2 * t.matrix[0] + 0.3 * t.matrix[1] + 0.1 * t.matrix[2], 1e-6);
    relume_image_destroy(&image);
}

static relume_status measure(const struct relume_image *image, struct test_log *log,
                             const double (*corner)[2])
{
    struct relume_chart t;
    test_log_init(log);
    return relume_chart_measure(&t, image, "p.jpg",
                                relume_chart_params(.log = &log->log, .corner = corner));
}

static void test_refused(void **state)
{
    static const double beside[4][2] = {{10, 10}, {200, 10}, {200, 140}, {10, 140}};
    static const double outside[4][2] = {{-50, -10}, {900, 10}, {900, 540}, {10, 540}};
    static const double line[4][2] = {{10, 10}, {20, 20}, {30, 30}, {40, 40}};
    struct relume_image image;
    struct test_log log;
    struct made_chart none = plain;
    (void)state;
    none.x = -5000;
    none.clutter = true;
    CHECK_OK(made_chart(&image, 660, 480, &none));
    assert_int_equal(measure(&image, &log, NULL), RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "p.jpg: no colour target found"));
    assert_int_equal(measure(&image, &log, beside), RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "no ColorChecker 24 between the corners"));
    assert_int_equal(measure(&image, &log, outside), RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "inside of the picture"));
    assert_int_equal(measure(&image, &log, line), RELUME_EUNFIT);
    memset(image.data, 0, 3 * 660 * 480 * sizeof(float));
    assert_int_equal(measure(&image, &log, NULL), RELUME_EUNFIT);
    assert_int_equal(measure(&image, &log, beside), RELUME_EUNFIT);
    relume_image_destroy(&image);
    // grey tiles in a grid are no target
    CHECK_OK(relume_image_create(&image, 400, 300, 3));
    for (int i = 0; i < 400 * 300; i++)
        for (int c = 0; c < 3; c++)
            image.data[3 * i + c] = i % 400 % 40 < 34 && i / 400 % 40 < 34 ? 0.5f : 0.1f;
    assert_int_equal(measure(&image, &log, NULL), RELUME_EUNFIT);
    relume_image_destroy(&image);
    CHECK_OK(relume_image_create(&image, 1, 1, 3));
    assert_int_equal(measure(&image, &log, NULL), RELUME_EUNFIT);
    relume_image_destroy(&image);
}

static void test_reference(void **state)
{
    char folder[64], path[96], text[2048];
    double own[RELUME_CHART_PATCHES][3], rgb[RELUME_CHART_PATCHES][3];
    struct test_log log;
    size_t n = 0;
    (void)state;
    // the published white is nearly white, and its luminance that of L* 95.19
    relume_chart_colours(rgb, NULL);
    CHECK_NEAR(0.2126 * rgb[18][0] + 0.7152 * rgb[18][1] + 0.0722 * rgb[18][2], 0.8806, 0.002);
    snprintf(path, sizeof path, "%s/own.txt", test_folder(folder));
    for (int i = 0; i < 24; i++)
        n += (size_t)snprintf(text + n, sizeof text - n, "%sA%d 50 %d 0.5\n",
                              i ? "" : "# own chart\n", i, i);
    test_write(path, text, n);
    test_log_init(&log);
    CHECK_OK(relume_chart_reference_load(own, path, &log.log));
    CHECK_NEAR(own[7][1], 7.0, 0.0);
    test_write(path, text, n - 10);
    assert_int_equal(relume_chart_reference_load(own, path, &log.log), RELUME_EFORMAT);
    test_write(path, "dark 1 nan 3\n", 13);
    assert_int_equal(relume_chart_reference_load(own, path, &log.log), RELUME_EFORMAT);
    assert_non_null(strstr(log.text, "line 1"));
    test_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exact),   cmocka_unit_test(test_anywhere),
        cmocka_unit_test(test_corners), cmocka_unit_test(test_clipped),
        cmocka_unit_test(test_refused), cmocka_unit_test(test_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
