// Near lights: what a table makes of them is what distant ones would show
#include "capture/manifest/reflectance_table.h"

#include "lambert_fixture.h"

// The largest difference between the table of a near capture and `n.D` under distant lights, over
// lights that meet the plane at more than `least`.
static double table_error(const struct bump *s, double least)
{
    char folder[64];
    relume_capture *capture = bump_open(s, folder);
    relume_table *table;
    const size_t pixels = BUMP_SIDE * BUMP_SIDE;
    float *v = calloc(3 * BUMP_LIGHTS * pixels, sizeof *v);
    double worst = 0.0;
    CHECK_OK(relume_table_open(&table, capture, 0, NULL));
    CHECK_OK(relume_table_read(table, BUMP_SIDE, v));
    for (int i = 0; i < BUMP_LIGHTS; i++)
        for (size_t k = 0; k < pixels; k++) {
            const struct relume_vec3 n =
                bump_normal(s, bump_point((int)k % BUMP_SIDE, (int)k / BUMP_SIDE));
            const double want = 0.7 * vec3_dot(n, bump_light(i));
            if (want > 0.7 * least)
                worst = fmax(worst, fabs((double)v[3 * ((size_t)i * pixels + k)] - want));
        }
    relume_table_destroy(&table);
    bump_close(&capture, folder);
    free(v);
    return worst;
}

// A matte plane is linear in the light: only the nugget, 1e-3 beside 3000, and the weights between
// nodes (directions are not linear over 4 of 40 pixels) lose anything.
static void a_plane_becomes_exact(void **state)
{
    (void)state;
    const struct bump s = {.near = true, .flat = true, .normal_of_plane = {0.05, -0.03, 1}};
    CHECK_NEAR(table_error(&s, 0.3), 0.0, 0.005);
}

static void without_falloff(void **state)
{
    (void)state;
    const struct bump s = {
        .near = true, .flat = true, .no_falloff = true, .normal_of_plane = {0.05, -0.03, 1}};
    CHECK_NEAR(table_error(&s, 0.3), 0.0, 0.005);
}

// Images come levelled: as if each pixel were as far from the light as the origin is.
static void images_are_levelled(void **state)
{
    (void)state;
    char folder[64];
    const struct bump s = {.near = true};
    const struct bump level = {.near = true, .no_falloff = true};
    relume_capture *capture = bump_open(&s, folder);
    struct relume_image image;
    CHECK_OK(relume_capture_image(&image, capture, 0, 2, NULL));
    for (int k = 0; k < BUMP_SIDE * BUMP_SIDE; k++)
        CHECK_NEAR((double)image.data[3 * k], bump_value(&level, 2, k % BUMP_SIDE, k / BUMP_SIDE),
                   1e-5);
    relume_image_destroy(&image);
    bump_close(&capture, folder);
}

// Bands of any height and any number of threads give the same bits.
static void bands_and_threads_agree(void **state)
{
    (void)state;
    char folder[64];
    relume_capture *capture = bump_open(&(struct bump){.near = true, .gloss = 0.3}, folder);
    const size_t row = 3 * BUMP_SIDE;
    float *whole = calloc(BUMP_LIGHTS * BUMP_SIDE * row, sizeof *whole);
    float *band = calloc(BUMP_LIGHTS * BUMP_SIDE * row, sizeof *band);
    relume_table *table;
    CHECK_OK(relume_table_open(&table, capture, 0, relume_table_params(.threads = 1)));
    CHECK_OK(relume_table_read(table, BUMP_SIDE, whole));
    relume_table_destroy(&table);
    CHECK_OK(relume_table_open(&table, capture, 0, relume_table_params(.threads = 3)));
    for (int y = 0, rows = 7; y < BUMP_SIDE; y += rows) {
        rows = BUMP_SIDE - y < 7 ? BUMP_SIDE - y : 7;
        CHECK_OK(relume_table_read(table, rows, band));
        for (size_t i = 0; i < BUMP_LIGHTS; i++)
            assert_memory_equal(band + i * (size_t)rows * row,
                                whole + (i * BUMP_SIDE + (size_t)y) * row,
                                (size_t)rows * row * sizeof *band);
    }
    relume_table_destroy(&table);
    bump_close(&capture, folder);
    free(whole);
    free(band);
}

// ---------------------------------------------------------------- panoramas

enum { PANO_WIDE = 32, PANO_HIGH = 16 };
static const struct relume_vec3 pano_lamp = {0.4, 0.5, -0.7}, pano_eye = {0.1, 0.0, 0.2};

// Inside of a matte sphere of radius 2 around the eye, by docs/conventions.md.
static struct relume_vec3 pano_ray(enum relume_projection p, int x, int y)
{
    const double phi = ((x + 0.5) / PANO_WIDE * 360 - 180) * M_PI / 180;
    const double e = (90 - (y + 0.5) / PANO_HIGH * 180) * M_PI / 180;
    return p == RELUME_SPHERICAL
               ? (struct relume_vec3){cos(e) * sin(phi), sin(e), -cos(e) * cos(phi)}
               : vec3_unit(
                     (struct relume_vec3){sin(phi), 1 - 2 * (y + 0.5) / PANO_HIGH, -cos(phi)});
}

static double pano_value(struct relume_vec3 ray, bool falls)
{
    const struct relume_vec3 to = {pano_lamp.x - pano_eye.x - 2 * ray.x,
                                   pano_lamp.y - pano_eye.y - 2 * ray.y,
                                   pano_lamp.z - pano_eye.z - 2 * ray.z};
    const double cosine = -vec3_dot(vec3_unit(to), ray);
    return 0.7 * cosine * (falls ? vec3_dot(pano_lamp, pano_lamp) / vec3_dot(to, to) : 1.0);
}

static void write_panorama(enum relume_projection p, bool depth, const char *folder)
{
    struct relume_image image, far;
    char path[128];
    const char *images[] = {"l.exr"};
    const struct relume_vec3 direction = vec3_unit(pano_lamp);
    CHECK_OK(relume_image_create(&image, PANO_WIDE, PANO_HIGH, 3));
    CHECK_OK(relume_image_create(&far, PANO_WIDE, PANO_HIGH, 1));
    for (int i = 0; i < PANO_WIDE * PANO_HIGH; i++) {
        far.data[i] = 2.0f;
        for (int c = 0; c < 3; c++)
            image.data[3 * i + c] =
                (float)pano_value(pano_ray(p, i % PANO_WIDE, i / PANO_WIDE), true);
    }
    snprintf(path, sizeof path, "%s/l.exr", folder);
    CHECK_OK(relume_image_save(&image, path, NULL));
    snprintf(path, sizeof path, "%s/d.exr", folder);
    CHECK_OK(relume_image_save(&far, path, NULL));
    const struct relume_manifest_view view = {.images = images, .depth = depth ? "d.exr" : NULL};
    struct relume_manifest m = {
        .geometry = relume_geometry_default(p, PANO_WIDE, PANO_HIGH),
        .lights = 1,
        .directions = &direction,
        .positions = &pano_lamp,
        .views = 1,
        .view = &view,
    };
    m.geometry.center = pano_eye;
    snprintf(path, sizeof path, "%s/capture.json", folder);
    CHECK_OK(relume_manifest_write(&m, path, NULL));
    relume_image_destroy(&image);
    relume_image_destroy(&far);
}

static void panoramas_are_levelled(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {  // a sphere, a cylinder, a sphere whose depth is assumed
        const enum relume_projection p = k == 1 ? RELUME_CYLINDRICAL : RELUME_SPHERICAL;
        char folder[64];
        relume_capture *capture;
        struct relume_image image;
        struct test_log log;
        test_folder(folder);
        test_log_init(&log);
        write_panorama(p, k < 2, folder);
        CHECK_OK(relume_capture_open(
            &capture, folder,
            relume_capture_params(.log = &log.log, .assume_depth = k == 2 ? 2.0 : 0.0)));
        assert_int_equal(log.lines, 0);
        CHECK_OK(relume_capture_image(&image, capture, 0, 0, NULL));
        for (int i = 0; i < PANO_WIDE * PANO_HIGH; i++)
            CHECK_NEAR((double)image.data[3 * i],
                       pano_value(pano_ray(p, i % PANO_WIDE, i / PANO_WIDE), false), 1e-6);
        relume_image_destroy(&image);
        bump_close(&capture, folder);
    }
}

static void a_panorama_without_depth_warns(void **state)
{
    (void)state;
    char folder[64];
    relume_capture *capture;
    struct test_log log;
    test_folder(folder);
    test_log_init(&log);
    write_panorama(RELUME_SPHERICAL, false, folder);
    CHECK_OK(relume_capture_open(&capture, folder, relume_capture_params(.log = &log.log)));
    assert_non_null(strstr(log.text, "--assume-depth"));
    bump_close(&capture, folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(panoramas_are_levelled), cmocka_unit_test(a_panorama_without_depth_warns),
        cmocka_unit_test(a_plane_becomes_exact),  cmocka_unit_test(without_falloff),
        cmocka_unit_test(images_are_levelled),    cmocka_unit_test(bands_and_threads_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
