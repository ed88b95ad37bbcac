// test_coder.c - polynomial and luminance coders against closed forms; what samples are read
#include "test.h"

#include "capture_fixture.h"
#include "format/coder/basis.h"
#include "format/coder/coding.h"

enum { LIGHTS = 40 };

static struct relume_vec3 dome[LIGHTS];
static char folder[64];

static int setup(void **state)
{
    (void)state;
    test_folder(folder);
    return relume_directions_make(dome, LIGHTS, relume_pattern_find("hammersley"),
                                  relume_directions_params(.hemisphere = true)) != RELUME_OK;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

// What `planes` of one pixel say for a direction.
static void value(const relume_coder *coder, const float *planes, struct relume_vec3 d, double *rgb)
{
    enum { MOST = 3 * LIGHTS };
    const struct relume_coder_info *info = relume_coder_info(coder);
    const int k = info->coefficients;
    float w[3 * MOST], constant[3];
    relume_coder_weights(coder, d, w, constant);
    for (int c = 0; c < 3; c++) {
        rgb[c] = (double)constant[c];
        for (int i = 0; i < k; i++)
            rgb[c] += (double)w[c * k + i] * (double)planes[relume_coder_plane(info, i, c)];
        rgb[c] *= info->luminance ? (double)planes[k + c] : 1.0;
    }
}

static double quadratic(struct relume_vec3 l, int c)
{
    return (0.4 + 0.1 * c) * l.x * l.x - 0.2 * l.y * l.y + 0.3 * l.x * l.y + 0.25 * l.x -
           0.5 * l.y + 0.7 - 0.1 * c;
}

// Values are assumed at the horizon with the weight 1e-4.
static void test_ptm_holds_quadratics(void **state)
{
    (void)state;
    relume_coder *coder;
    CHECK_OK(relume_coder_create(
        &coder, &relume_basis_ptm, dome, LIGHTS,
        relume_coder_params(.coefficients = 6, .hemispherical = true, .ridge = 1e-12)));
    float samples[LIGHTS][3], planes[18];
    for (int i = 0; i < LIGHTS; i++)
        for (int c = 0; c < 3; c++)
            samples[i][c] = (float)quadratic(dome[i], c);
    CHECK_OK(relume_coder_apply(coder, &samples[0][0], 3, 1, planes, 1));
    uint32_t seed = 5;
    for (int i = 0; i < 100; i++) {
        struct relume_vec3 d = test_direction(&seed);
        double rgb[3];
        d.z = fabs(d.z);
        value(coder, planes, d, rgb);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(rgb[c], quadratic(d, c), 2e-3);
    }
    relume_coder_destroy(&coder);
}

// Without smoothing what is left is orthogonal to every function, as least squares has it; the
// usual ridge leaves 4e-5 of the second degree. Lights that do not determine the fit are refused
// then.
static void test_no_ridge(void **state)
{
    (void)state;
    enum { N = 40, K = 9 };
    struct relume_vec3 light[N];
    relume_coder *coder;
    float samples[N][3], planes[3 * K];
    double left[N], most = 0.0;
    uint32_t seed = 3;
    for (int i = 0; i < N; i++) {
        const double z = 1.0 - (2 * i + 1.0) / N, r = sqrt(1.0 - z * z), phi = 2.399963 * i;
        light[i] = (struct relume_vec3){r * cos(phi), r * sin(phi), z};
        for (int c = 0; c < 3; c++)
            samples[i][c] = (float)(test_direction(&seed).x + (i % 5 == 0));
    }
    CHECK_OK(relume_coder_create(&coder, &relume_basis_sh, light, N,
                                 relume_coder_params(.coefficients = K, .no_ridge = true)));
    CHECK_NEAR(relume_coder_info(coder)->ridge, 0.0, 0.0);
    CHECK_OK(relume_coder_apply(coder, &samples[0][0], 3, 1, planes, 1));
    for (int i = 0; i < N; i++) {
        double rgb[3];
        value(coder, planes, light[i], rgb);
        left[i] = (double)samples[i][0] - rgb[0];
    }
    for (int k = 0; k < K; k++) {
        double sum = 0.0, values[K];
        for (int i = 0; i < N; i++) {
            relume_basis_sh.evaluate(coder, light[i], values);
            sum += left[i] * values[k] / N;
        }
        most = fmax(most, fabs(sum));
    }
    assert_true(most < 2e-6);  // floats
    relume_coder_destroy(&coder);
    for (int i = 0; i < N; i++)
        light[i] = (struct relume_vec3){cos(0.5 * i), sin(0.5 * i), 0.0};
    const struct relume_coder_params ring = {.coefficients = K, .force = true};
    CHECK_OK(relume_coder_create(&coder, &relume_basis_sh, light, N, &ring));
    relume_coder_destroy(&coder);
    struct relume_coder_params bare = ring;
    bare.no_ridge = true;
    assert_int_equal(relume_coder_create(&coder, &relume_basis_sh, light, N, &bare), RELUME_EUNFIT);
    bare.ridge = 0.1;
    assert_int_equal(relume_coder_create(&coder, &relume_basis_sh, light, N, &bare), RELUME_EINVAL);
}

// A grey shading times a colour: the colour plane holds what differs, exactly where the basis holds
// the shading.
static void test_luminance_of_coloured_greys(void **state)
{
    (void)state;
    static const double colour[3] = {0.9, 0.5, 0.1};
    const struct relume_basis *const bases[] = {&relume_basis_table, &relume_basis_ptm};
    for (int b = 0; b < 2; b++) {
        relume_coder *coder;
        CHECK_OK(relume_coder_create(
            &coder, bases[b], dome, LIGHTS,
            relume_coder_params(.luminance = true, .hemispherical = true, .ridge = 1e-12)));
        const struct relume_coder_info *info = relume_coder_info(coder);
        assert_true(info->joint && info->luminance);
        assert_int_equal(info->planes, info->coefficients + 3);
        float samples[LIGHTS][3], planes[LIGHTS + 3];
        for (int i = 0; i < LIGHTS; i++)
            for (int c = 0; c < 3; c++)
                samples[i][c] = (float)(colour[c] * quadratic(dome[i], 0));
        CHECK_OK(relume_coder_apply(coder, &samples[0][0], 3, 1, planes, 1));
        CHECK_NEAR((double)(planes[info->coefficients] / planes[info->coefficients + 1]), 1.8,
                   1e-5);
        for (int i = 0; i < LIGHTS; i++) {
            double rgb[3];
            value(coder, planes, dome[i], rgb);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(rgb[c], colour[c] * quadratic(dome[i], 0), b ? 2e-3 : 2e-6);
        }
        relume_coder_destroy(&coder);
    }
}

// Black pixels have no colour to divide by.
static void test_luminance_of_black(void **state)
{
    (void)state;
    relume_coder *coder;
    float samples[LIGHTS][3] = {{0}}, planes[LIGHTS + 3];
    CHECK_OK(relume_coder_create(&coder, &relume_basis_table, dome, LIGHTS,
                                 relume_coder_params(.luminance = true)));
    CHECK_OK(relume_coder_apply(coder, &samples[0][0], 3, 1, planes, 1));
    for (int p = 0; p < LIGHTS + 3; p++)
        CHECK_NEAR((double)planes[p], 0.0, 0.0);
    relume_coder_destroy(&coder);
}

// More pixels than a chunk holds, at any stride: each as if it were alone.
static void test_apply_is_pixel_by_pixel(void **state)
{
    (void)state;
    enum { N = 2 * CODER_CHUNK + 37, STRIDE = 3 * N + 5, K = 9, PLANE = N + 3 };
    float *samples = malloc(sizeof(float) * LIGHTS * STRIDE);
    float *planes = malloc(sizeof(float) * 3 * K * PLANE), one[LIGHTS][3], alone[3 * K];
    uint32_t seed = 3;
    relume_coder *coder;
    for (int i = 0; i < LIGHTS * STRIDE; i++)
        samples[i] = (float)test_uniform(&seed);
    CHECK_OK(relume_coder_create(&coder, &relume_basis_hsh, dome, LIGHTS,
                                 relume_coder_params(.coefficients = K, .hemispherical = true)));
    CHECK_OK(relume_coder_apply(coder, samples, STRIDE, N, planes, PLANE));
    for (int x = 0; x < N; x += 61) {
        for (int i = 0; i < LIGHTS; i++)
            memcpy(one[i], samples + i * STRIDE + 3 * x, sizeof one[i]);
        CHECK_OK(relume_coder_apply(coder, &one[0][0], 3, 1, alone, 1));
        for (int p = 0; p < 3 * K; p++)
            CHECK_NEAR((double)planes[p * PLANE + x], (double)alone[p], 1e-5);
    }
    free(samples);
    free(planes);
    relume_coder_destroy(&coder);
}

// ---------------------------------------------------------------- samples of a capture

static const struct fixture shape = {
    .width = 23, .height = 37, .lights = 7, .views = 2, .hemisphere = true, .mask = true};

static float number_of(int view, int at, int light, int c)
{
    return (float)(1000 * view + at) + 0.25f * (float)c + 0.03125f * (float)light;
}

// Each pixel holds its number.
static relume_capture *open_capture(void)
{
    relume_capture *capture;
    struct relume_image image;
    char path[128];
    fixture_write(&shape, folder);
    CHECK_OK(relume_image_create(&image, shape.width, shape.height, 3));
    for (int i = 0; i < shape.views * shape.lights; i++) {
        for (int j = 0; j < 3 * shape.width * shape.height; j++)
            image.data[j] = number_of(i / shape.lights, j / 3, i % shape.lights, j % 3);
        snprintf(path, sizeof path, "%s/v%d-%d.exr", folder, i / shape.lights, i % shape.lights);
        CHECK_OK(relume_image_save(&image, path, NULL));
    }
    relume_image_destroy(&image);
    CHECK_OK(relume_capture_open(&capture, folder, NULL));
    return capture;
}

// Which pixel of which view a sample is, the same for all lights; a masked one is none.
static void find(const struct relume_samples *s, size_t pixel, int *view, int *at)
{
    const int number = (int)s->data[3 * pixel];
    *view = number / 1000;
    *at = number % 1000;
    assert_true(*view < shape.views && *at<shape.width * shape.height && * at % 5> 0);
    for (int i = 0; i < shape.lights; i++)
        for (int c = 0; c < 3; c++)
            assert_true(s->data[((size_t)i * s->pixels + pixel) * 3 + (size_t)c] ==
                        number_of(*view, *at, i, c));
}

static void test_all_pixels_once(void **state)
{
    (void)state;
    relume_capture *capture = open_capture();
    enum { ALL = 23 * 37 };
    for (int round = 0; round < 2; round++) {
        struct relume_samples s;
        bool seen[2][ALL] = {{false}};
        CHECK_OK(relume_samples_read(&s, capture, round ? 0 : 2 * ALL, NULL));
        assert_int_equal(s.lights, shape.lights);
        assert_int_equal(s.pixels, 2 * (ALL - (ALL + 4) / 5));
        for (size_t x = 0; x < s.pixels; x++) {
            int view, at;
            find(&s, x, &view, &at);
            assert_false(seen[view][at]);
            seen[view][at] = true;
        }
        relume_samples_destroy(&s);
    }
    relume_capture_destroy(&capture);
}

static void test_some_pixels_of_everywhere(void **state)
{
    (void)state;
    relume_capture *capture = open_capture();
    struct relume_samples s, again;
    int per_view[2] = {0}, upper = 0;
    CHECK_OK(relume_samples_read(&s, capture, 200, relume_project_params(.threads = 1)));
    assert_true(s.pixels > 130 && s.pixels <= 200);
    for (size_t x = 0; x < s.pixels; x++) {
        int view, at;
        find(&s, x, &view, &at);
        per_view[view]++;
        upper += at < shape.width * shape.height / 2;
    }
    assert_true(per_view[0] > 60 && per_view[1] > 60);
    assert_true(abs(2 * upper - (int)s.pixels) < 20);
    CHECK_OK(relume_samples_read(&again, capture, 200, relume_project_params(.threads = 7)));
    assert_int_equal(again.pixels, s.pixels);
    assert_memory_equal(again.data, s.data, sizeof(float) * 3 * s.pixels * (size_t)s.lights);
    relume_samples_destroy(&again);
    relume_samples_destroy(&s);
    relume_capture_destroy(&capture);
}

static void test_samples_of_the_display_domain(void **state)
{
    (void)state;
    relume_capture *capture = open_capture();
    struct relume_samples linear, display;
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    CHECK_OK(relume_samples_read(&linear, capture, 100, NULL));
    CHECK_OK(relume_samples_read(&display, capture, 100,
                                 relume_project_params(.domain = RELUME_DOMAIN_DISPLAY)));
    assert_int_equal(display.pixels, linear.pixels);
    for (size_t i = 0; i < 3 * linear.pixels * (size_t)linear.lights; i++)
        CHECK_NEAR((double)display.data[i], (double)relume_transfer_encode(srgb, linear.data[i]),
                   1e-5);
    relume_samples_destroy(&linear);
    relume_samples_destroy(&display);
    relume_capture_destroy(&capture);
}

// ---------------------------------------------------------------- the census

// Eight-bit images: pixel 0 black throughout, 1 white throughout, 2 white under one light, 3 white
// in blue under one light, 4 black under one light; the last column is masked in view 1.
static void test_census(void **state)
{
    (void)state;
    enum { W = 6, H = 2, N = 4 };
    struct relume_manifest_view view[2] = {{.uv = {0}}, {.uv = {1}, .mask = "mask.png"}};
    const char *images[2 * N];
    char path[512], names[2 * N][32];
    struct relume_image image, mask;
    CHECK_OK(relume_image_create(&image, W, H, 3));
    CHECK_OK(relume_image_create(&mask, W, H, 1));
    for (int i = 0; i < 2 * N; i++) {
        const int light = i % N;
        for (int j = 0; j < 3 * W * H; j++)
            image.data[j] = 0.5f;
        for (int c = 0; c < 3; c++) {
            image.data[c] = 0.0f;
            image.data[3 + c] = 1.0f;
            image.data[6 + c] = light == 2 ? 1.0f : 0.5f;
            image.data[9 + c] = light == 1 && c == 2 ? 1.0f : 0.9f;
            image.data[12 + c] = light ? 0.5f : 0.0f;
        }
        snprintf(names[i], sizeof names[i], "%d.png", i);
        images[i] = names[i];
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        if (i == 3)  // under light 3 view 0 is black
            memset(image.data, 0, sizeof(float) * 3 * W * H);
        CHECK_OK(relume_image_save(&image, path, NULL));
    }
    for (int i = 0; i < W * H; i++)
        mask.data[i] = i % W < W - 1;
    snprintf(path, sizeof path, "%s/mask.png", folder);
    CHECK_OK(relume_image_save(&mask, path, NULL));
    view[0].images = images;
    view[1].images = images + N;
    const float intensities[N][3] = {{1, 1, 1}, {2, 2, 0.5f}, {3, 3, 3}, {1, 1, 1}};
    struct relume_manifest m = {.transfer = {.curve = RELUME_CURVE_SRGB},
                                .geometry = relume_geometry_default(RELUME_SLAB, W, H),
                                .lights = N,
                                .directions = dome,
                                .views = 2,
                                .view = view};
    for (int round = 0; round < 4; round++) {
        relume_capture *capture;
        relume_coder *coder;
        struct relume_fidelity r;
        m.intensities = round % 2 ? intensities : NULL;
        snprintf(path, sizeof path, "%s/capture.json", folder);
        CHECK_OK(relume_manifest_write(&m, path, NULL));
        CHECK_OK(relume_capture_open(&capture, folder, NULL));
        CHECK_OK(relume_coder_learn(&coder, &relume_basis_table, capture, NULL, NULL));
        snprintf(path, sizeof path, "%s/census.exr", folder);
        CHECK_OK(relume_pack_encode(
            capture, coder, path, &r,
            relume_pack_encode_params(.domain = round / 2 ? RELUME_DOMAIN_LINEAR
                                                          : RELUME_DOMAIN_DISPLAY)));
        assert_int_equal(r.census.pixels, 2 * W * H - 2);
        assert_int_equal(r.census.black, 2);
        assert_int_equal(r.census.clipped, 6);
        assert_int_equal(r.census.always_clipped, 1);  // view 0 is black under one light
        assert_int_equal(r.census.black_images, 1);
        assert_int_equal(r.census.repaired, 0);
        relume_coder_destroy(&coder);
        relume_capture_destroy(&capture);
    }
    relume_image_destroy(&image);
    relume_image_destroy(&mask);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ptm_holds_quadratics),
        cmocka_unit_test(test_no_ridge),
        cmocka_unit_test(test_luminance_of_coloured_greys),
        cmocka_unit_test(test_luminance_of_black),
        cmocka_unit_test(test_apply_is_pixel_by_pixel),
        cmocka_unit_test(test_all_pixels_once),
        cmocka_unit_test(test_some_pixels_of_everywhere),
        cmocka_unit_test(test_samples_of_the_display_domain),
        cmocka_unit_test(test_census),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
