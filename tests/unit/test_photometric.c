// Normals, height and refined lights of a surface whose every sample is known
#include "lambert_fixture.h"

#include "capture/acquire/photometric.h"
#include "capture/acquire/refine.h"
#include "core/math/fft.h"

// Mean angle between the fitted and the true normals, degrees.
static double error_of(const struct relume_image *normal, const struct bump *s)
{
    double sum = 0.0;
    for (int k = 0; k < BUMP_SIDE * BUMP_SIDE; k++) {
        const float *n = normal->data + 3 * k;
        const struct relume_vec3 found = {(double)n[0], (double)n[1], (double)n[2]};
        const struct relume_vec3 want = bump_normal(s, bump_point(k % BUMP_SIDE, k / BUMP_SIDE));
        sum += acos(fmin(vec3_dot(found, want), 1.0)) * 180.0 / M_PI;
    }
    return sum / (BUMP_SIDE * BUMP_SIDE);
}

static double fit(const struct bump *s, bool plain)
{
    char folder[64];
    relume_capture *capture = bump_open(s, folder);
    struct relume_photometric p;
    CHECK_OK(relume_photometric_fit(&p, capture, 0, relume_photometric_params(.plain = plain)));
    if (!plain) {
        CHECK_NEAR((double)p.albedo.data[0], 0.7, 0.01);
        CHECK_NEAR(p.residual, 0.0, 0.01);
        CHECK_NEAR(p.light_residual[3], 0.0, 0.01);
    }
    const double error = error_of(&p.normal, s);
    relume_photometric_destroy(&p);
    bump_close(&capture, folder);
    return error;
}

// Single precision files and samples without an outlier: hardly anything is lost.
static void exact_without_outliers(void **state)
{
    (void)state;
    CHECK_NEAR(fit(&(struct bump){0}, true), 0.0, 0.05);
    CHECK_NEAR(fit(&(struct bump){0}, false), 0.0, 0.05);
}

static void outliers_are_left_out(void **state)
{
    (void)state;
    const struct bump s = {.gloss = 0.6, .shadows = true};
    const double robust = fit(&s, false), plain = fit(&s, true);
    CHECK_NEAR(robust, 0.0, 0.2);
    assert_true(plain > 10.0 * robust);
}

static void near_lights(void **state)
{
    (void)state;
    if (!TEST_SANITIZED)
        CHECK_NEAR(fit(&(struct bump){.near = true}, false), 0.0, 0.05);
    CHECK_NEAR(fit(&(struct bump){.near = true, .no_falloff = true}, false), 0.0, 0.05);
}

// A bulb carried around, near and far: each photograph is as bright as it makes it. Photographs
// that were made equally bright say so.
static void lamps_at_unequal_distances(void **state)
{
    (void)state;
    const struct bump bulb = {.near = true, .uneven = true};
    const struct bump levelled = {.near = true, .uneven = true, .level = true};
    CHECK_NEAR(fit(&bulb, true), 0.0, 0.05);
    CHECK_NEAR(fit(&levelled, true), 0.0, 0.05);
    if (!TEST_SANITIZED)
        CHECK_NEAR(fit(&bulb, false), 0.0, 0.05);
}

static void too_few_lights(void **state)
{
    (void)state;
    char folder[64], path[128];
    struct relume_photometric p;
    struct test_log log;
    relume_capture *capture = bump_open(&(struct bump){0}, folder);
    const struct relume_manifest *m = relume_capture_manifest(capture);
    const struct relume_vec3 ring[3] = {{0.6, 0, 0.8}, {-0.6, 0, 0.8}, {0, 0, 1}};
    struct relume_manifest flat = *m;
    flat.lights = 3;
    flat.directions = ring;
    struct relume_manifest_view view = m->view[0];
    const char *const names[3] = {"l0.exr", "l1.exr", "l2.exr"};
    view.images = (const char **)(uintptr_t)names;
    flat.view = &view;
    snprintf(path, sizeof path, "%s/flat.json", folder);
    CHECK_OK(relume_manifest_write(&flat, path, NULL));
    relume_capture_destroy(&capture);
    CHECK_OK(relume_capture_open(&capture, path, NULL));
    test_log_init(&log);
    assert_int_equal(
        relume_photometric_fit(&p, capture, 0, relume_photometric_params(.log = &log.log)),
        RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "in one plane; found"));
    assert_null(p.normal.data);
    bump_close(&capture, folder);
}

// ---------------------------------------------------------------- height

// Slopes are taken half a pixel too wide: second order in the pixel, 1 % of the height here.
static void height_of_the_bump(void **state)
{
    (void)state;
    const struct bump s = {0};
    struct relume_image normal, height;
    double mean = 0.0, squares = 0.0;
    CHECK_OK(relume_image_create(&normal, BUMP_SIDE, BUMP_SIDE, 3));
    for (int k = 0; k < BUMP_SIDE * BUMP_SIDE; k++) {
        const struct relume_vec3 p = bump_point(k % BUMP_SIDE, k / BUMP_SIDE);
        const struct relume_vec3 n = bump_normal(&s, p);
        normal.data[3 * k] = (float)n.x;
        normal.data[3 * k + 1] = (float)n.y;
        normal.data[3 * k + 2] = (float)n.z;
        mean += bump_height(p) / (BUMP_SIDE * BUMP_SIDE);
    }
    CHECK_OK(
        relume_height_integrate(&height, &normal, relume_height_params(.pixel = 2.0 / BUMP_SIDE)));
    for (int k = 0; k < BUMP_SIDE * BUMP_SIDE; k++) {
        const double want = bump_height(bump_point(k % BUMP_SIDE, k / BUMP_SIDE)) - mean;
        squares += pow((double)height.data[k] - want, 2.0) / (BUMP_SIDE * BUMP_SIDE);
    }
    CHECK_NEAR(sqrt(squares), 0.0, 0.01 * 0.25);
    relume_image_destroy(&normal);
    relume_image_destroy(&height);
}

enum { TENT_SIDE = 96 };

// A tent on a plane: what rises from it along two sides stands over it at the two others.
static double tent_height(size_t at)
{
    const struct relume_vec3 p = {2.0 * ((double)(at % TENT_SIDE) + 0.5) / TENT_SIDE - 1.0,
                                  2.0 * ((double)(at / TENT_SIDE) + 0.5) / TENT_SIDE - 1.0, 0.0};
    return fabs(p.y) < 0.6 ? fmax(0.5 - fabs(p.x), 0.0) : 0.0;
}

// Slopes of the sides alone; a disc beside the tent may be unknown.
static void tent_normals(struct relume_image *normal, bool hole)
{
    CHECK_OK(relume_image_create(normal, TENT_SIDE, TENT_SIDE, 3));
    for (size_t at = 0; at < TENT_SIDE * TENT_SIDE; at++) {
        const double x = 2.0 * ((double)(at % TENT_SIDE) + 0.5) / TENT_SIDE - 1.0;
        const double y = (double)(at / TENT_SIDE) - 10.0;
        const bool rises = tent_height(at) > 0.0;
        if (hole && hypot((x + 1.0) * TENT_SIDE / 2.0 - 15.0, y) < 6.0)
            continue;
        normal->data[3 * at] = rises ? (float)copysign(sqrt(0.5), x) : 0.0f;
        normal->data[3 * at + 2] = rises ? (float)sqrt(0.5) : 1.0f;
    }
}

// RMS difference from the tent, world units, where normals are known.
static double tent_error(const struct relume_image *normal, bool smooth, int threads,
                         const struct relume_image *confidence)
{
    struct relume_image height;
    CHECK_OK(relume_height_integrate(&height, normal,
                                     relume_height_params(.pixel = 2.0 / TENT_SIDE,
                                                          .smooth = smooth, .threads = threads,
                                                          .confidence = confidence)));
    double sum = 0.0, squares = 0.0, n = 0.0;
    for (size_t at = 0; at < TENT_SIDE * TENT_SIDE; at++)
        if (normal->data[3 * at + 2] > 0.0f) {
            const double d = (double)height.data[at] - tent_height(at);
            sum += d;
            squares += d * d;
            n += 1.0;
        }
    relume_image_destroy(&height);
    return sqrt(squares / n - sum * sum / (n * n));
}

// Least squares of all slopes bend tent and plane to meet; a tenth of the tent's height.
static void steps_are_kept(void **state)
{
    (void)state;
    struct relume_image normal;
    for (int hole = 0; hole < 2; hole++) {
        tent_normals(&normal, hole);
        // a fifth of a pixel: the creases lie between pixels
        CHECK_NEAR(tent_error(&normal, false, 1, NULL), 0.0, 0.2 * 2.0 / TENT_SIDE);
        assert_true(tent_error(&normal, true, 1, NULL) > 0.07);
        relume_image_destroy(&normal);
    }
}

// Every other pixel of a wave is wrong, and said to be so.
static void confidence_counts(void **state)
{
    (void)state;
    enum { SIDE = 48 };
    struct relume_image normal, sure, height;
    double error[2] = {0.0, 0.0};
    CHECK_OK(relume_image_create(&normal, SIDE, SIDE, 3));
    CHECK_OK(relume_image_create(&sure, SIDE, SIDE, 1));
    for (int at = 0; at < SIDE * SIDE; at++) {
        const bool wrong = (at / SIDE + at % SIDE) % 2;
        const double slope = 0.5 * cos(0.2 * (at % SIDE)) + (wrong ? 0.2 : 0.0);
        const struct relume_vec3 n = vec3_unit((struct relume_vec3){-slope, 0.0, 1.0});
        normal.data[3 * at] = (float)n.x;
        normal.data[3 * at + 2] = (float)n.z;
        sure.data[at] = wrong ? 0.0f : 1.0f;
    }
    for (int i = 0; i < 2; i++) {
        CHECK_OK(relume_height_integrate(&height, &normal,
                                         relume_height_params(.confidence = i ? &sure : NULL)));
        for (int x = 0; x < SIDE; x++)
            error[i] += fabs((double)height.data[SIDE * 20 + x] - (double)height.data[SIDE * 20] -
                             2.5 * sin(0.2 * x));
        relume_image_destroy(&height);
    }
    assert_true(error[1] < 0.2 * error[0]);  // a twentieth of the weight
    sure.width--;
    assert_int_equal(
        relume_height_integrate(&height, &normal, relume_height_params(.confidence = &sure)),
        RELUME_EINVAL);
    sure.width++;
    relume_image_destroy(&normal);
    relume_image_destroy(&sure);
}

// Larger than what is solved without a coarser one, and so wide that a screen of 1e-6 would take a
// tenth of the height; odd sizes, and the same bits for any number of threads.
static void wide_shapes_keep_their_height(void **state)
{
    (void)state;
    enum { W = 1201, H = 77 };
    struct relume_image normal, height[2];
    CHECK_OK(relume_image_create(&normal, W, H, 3));
    const double most = 0.05 * W, turn = M_PI / W;
    for (size_t at = 0; at < (size_t)W * H; at++) {
        const double slope = -most * turn * sin(turn * ((double)(at % W) + 0.5));
        const struct relume_vec3 n = vec3_unit((struct relume_vec3){-slope, 0.0, 1.0});
        normal.data[3 * at] = (float)n.x;
        normal.data[3 * at + 2] = (float)n.z;
    }
    for (int smooth = 0; smooth < 2; smooth++) {
        for (int i = 0; i < 2; i++)
            CHECK_OK(relume_height_integrate(
                &height[i], &normal, relume_height_params(.threads = i ? 3 : 1, .smooth = smooth)));
        assert_memory_equal(height[0].data, height[1].data, sizeof(float) * W * H);
        for (size_t x = 0; x < W; x += 100)  // a thousandth by the screen
            CHECK_NEAR((double)height[0].data[(H / 2) * (size_t)W + x],
                       most * cos(turn * ((double)x + 0.5)), 0.003 * most);
        relume_image_destroy(&height[0]);
        relume_image_destroy(&height[1]);
    }
    relume_image_destroy(&normal);
}

static void cosine_transform(void **state)
{
    (void)state;
    enum { W = 7, H = 6 };
    float x[H][W], back[H][W];
    for (int i = 0; i < W * H; i++)
        x[i / W][i % W] = back[i / W][i % W] = (float)sin(1.7 * i * i);
    CHECK_OK(fft_cosine(back[0], W, H, false));
    for (int v = 0; v < H; v++)
        for (int u = 0; u < W; u++) {
            double sum = 0.0;
            for (int i = 0; i < W * H; i++)
                sum += 4.0 * (double)x[i / W][i % W] * cos(M_PI * (i % W + 0.5) * u / W) *
                       cos(M_PI * (i / W + 0.5) * v / H);
            CHECK_NEAR((double)back[v][u], sum, 1e-4);  // some 100 additions of size 1
        }
    CHECK_OK(fft_cosine(back[0], W, H, true));
    for (int i = 0; i < W * H; i++)
        CHECK_NEAR((double)back[i / W][i % W], (double)x[i / W][i % W], 1e-6);
}

// ---------------------------------------------------------------- refined lights

// Lights that are off by some degrees, each in its own direction, and of different brightness.
static void refined_lights(void **state)
{
    (void)state;
    double brightness[BUMP_LIGHTS], residual[2], found[BUMP_LIGHTS], mean = 0.0;
    for (int i = 0; i < BUMP_LIGHTS; i++) {
        brightness[i] = 1.0 + 0.2 * sin(3.0 * i);
        mean += brightness[i] / BUMP_LIGHTS;
    }
    char folder[64], path[128];
    const struct bump s = {.brightness = brightness};
    relume_capture *capture = bump_open(&s, folder);
    struct relume_manifest m = *relume_capture_manifest(capture);
    struct relume_vec3 wrong[BUMP_LIGHTS], refined[BUMP_LIGHTS];
    double before = 0.0, after = 0.0;
    const char *names[BUMP_LIGHTS];
    char name[BUMP_LIGHTS][32];
    for (int i = 0; i < BUMP_LIGHTS; i++) {
        const struct relume_vec3 d = bump_light(i);
        wrong[i] = refined[i] = vec3_unit((struct relume_vec3){
            d.x + 0.05 * sin(5.0 * i), d.y + 0.05 * cos(11.0 * i), d.z + 0.05 * sin(17.0 * i)});
        before += acos(vec3_dot(wrong[i], d)) * 180.0 / M_PI / BUMP_LIGHTS;
        snprintf(name[i], sizeof name[i], "l%d.exr", i);
        names[i] = name[i];
    }
    struct relume_manifest_view view = {.images = names};
    m.directions = wrong;
    m.view = &view;
    snprintf(path, sizeof path, "%s/wrong.json", folder);
    CHECK_OK(relume_manifest_write(&m, path, NULL));
    relume_capture_destroy(&capture);
    CHECK_OK(relume_capture_open(&capture, path, NULL));
    CHECK_OK(relume_acquire_refine(refined, found, residual, capture, NULL));
    for (int i = 0; i < BUMP_LIGHTS; i++)
        after += acos(fmin(vec3_dot(refined[i], bump_light(i)), 1.0)) * 180.0 / M_PI / BUMP_LIGHTS;
    // What stays is the error that all lights share, a linear map fitted to 14 of them: the root of
    // 9 of 28 degrees of freedom, 0.57 of what there was.
    assert_true(after < 0.7 * before);
    assert_true(residual[1] < 0.1 * residual[0]);
    for (int i = 0; i < BUMP_LIGHTS; i++)
        CHECK_NEAR(found[i], brightness[i] / mean, 0.06);
    bump_close(&capture, folder);
}

// Brightness alone: directions stay to the bit, and what each lamp gave is found: to what 100
// rounds leave, and where one sample in seven is shadow to what shadows pull, of 30 % that lamps
// differ.
static void refined_brightness(void **state)
{
    (void)state;
    const double tolerance[] = {0.005, 0.06};
    double brightness[BUMP_LIGHTS], residual[2], found[BUMP_LIGHTS], mean = 0.0;
    for (int i = 0; i < BUMP_LIGHTS; i++) {
        brightness[i] = 1.0 + 0.3 * sin(3.0 * i);
        mean += brightness[i] / BUMP_LIGHTS;
    }
    for (int k = TEST_SANITIZED ? 1 : 0; k < 2; k++) {
        char folder[64];
        const struct bump s = {.brightness = brightness, .shadows = k == 1};
        relume_capture *capture = bump_open(&s, folder);
        const struct relume_manifest *m = relume_capture_manifest(capture);
        struct relume_vec3 direction[BUMP_LIGHTS];
        memcpy(direction, m->directions, sizeof direction);
        CHECK_OK(relume_acquire_refine(direction, found, residual, capture,
                                       &(struct relume_acquire_refine_params){.brightness = true}));
        for (int i = 0; i < BUMP_LIGHTS; i++) {
            CHECK_NEAR(vec3_dot(direction[i], m->directions[i]), 1.0, 1e-12);
            CHECK_NEAR(found[i], brightness[i] / mean, tolerance[k]);
        }
        assert_true(residual[1] < 0.5 * residual[0]);
        bump_close(&capture, folder);
    }
}

// The power of near lights, of a bump and of a plate, and which of them differs from the others.
static void refined_power_of_near_lamps(void **state)
{
    (void)state;
    double brightness[BUMP_LIGHTS], residual[2], found[BUMP_LIGHTS];
    for (int i = 0; i < BUMP_LIGHTS; i++)
        brightness[i] = i == 5 ? 0.7 : 1.0;
    for (int flat = TEST_SANITIZED ? 1 : 0; flat < 2; flat++) {
        char folder[64];
        const struct bump s = {.near = true,
                               .uneven = true,
                               .flat = flat,
                               .brightness = brightness,
                               .normal_of_plane = {0.1, 0, 1}};
        relume_capture *capture = bump_open(&s, folder);
        struct relume_vec3 direction[BUMP_LIGHTS];
        struct relume_photometric p;
        CHECK_OK(relume_acquire_refine(direction, found, residual, capture,
                                       &(struct relume_acquire_refine_params){.brightness = true}));
        const double mean = 1.0 - 0.3 / BUMP_LIGHTS;
        for (int i = 0; i < BUMP_LIGHTS; i++)
            CHECK_NEAR(found[i], brightness[i] / mean, 0.005);
        CHECK_OK(relume_photometric_fit(&p, capture, 0, NULL));
        CHECK_NEAR(p.light_gain[5], 0.7, 0.02);
        CHECK_NEAR(p.light_gain[6], 1.0, 0.02);
        assert_true(p.mended_residual[5] < 0.1 * p.light_residual[5]);
        relume_photometric_destroy(&p);
        bump_close(&capture, folder);
    }
}

enum common_error { TURNED, TILTED, STRETCHED, EACH };

static struct relume_vec3 mistaken(enum common_error e, int i)
{
    const struct relume_vec3 d = bump_light(i);
    const double c = cos(0.07), s = sin(0.07);  // 4 degrees
    if (e == TURNED)
        return (struct relume_vec3){c * d.x - s * d.y, s * d.x + c * d.y, d.z};
    if (e == TILTED)
        return (struct relume_vec3){d.x, c * d.y - s * d.z, s * d.y + c * d.z};
    if (e == STRETCHED)
        return vec3_unit((struct relume_vec3){1.08 * d.x, 0.93 * d.y, d.z});
    return vec3_unit((struct relume_vec3){d.x + 0.05 * sin(5.0 * i), d.y + 0.05 * cos(11.0 * i),
                                          d.z + 0.05 * sin(17.0 * i)});
}

// Mean error of refined lights over that of those given.
static double refined_error(const struct bump *s, enum common_error e, bool integrable,
                            double curl[2])
{
    char folder[64], path[128], name[BUMP_LIGHTS][32];
    relume_capture *capture = bump_open(s, folder);
    struct relume_manifest m = *relume_capture_manifest(capture);
    struct relume_vec3 given[BUMP_LIGHTS], refined[BUMP_LIGHTS];
    const char *names[BUMP_LIGHTS];
    double residual[2], found[BUMP_LIGHTS], before = 0.0, after = 0.0;
    for (int i = 0; i < BUMP_LIGHTS; i++) {
        given[i] = refined[i] = mistaken(e, i);
        snprintf(name[i], sizeof name[i], "l%d.exr", i);
        names[i] = name[i];
    }
    const struct relume_manifest_view view = {.images = names};
    m.directions = given;
    m.view = &view;
    snprintf(path, sizeof path, "%s/wrong.json", folder);
    CHECK_OK(relume_manifest_write(&m, path, NULL));
    relume_capture_destroy(&capture);
    CHECK_OK(relume_capture_open(&capture, path, NULL));
    CHECK_OK(relume_acquire_refine(
        refined, found, residual, capture,
        &(struct relume_acquire_refine_params){.integrable = integrable, .curl = curl}));
    for (int i = 0; i < BUMP_LIGHTS; i++) {
        before += acos(fmin(vec3_dot(given[i], bump_light(i)), 1.0));
        after += acos(fmin(vec3_dot(refined[i], bump_light(i)), 1.0));
    }
    bump_close(&capture, folder);
    return after / before;
}

// What all lights share: turned about the axis of view, tilted, stretched. A common error stays
// without integrability. A tilt is nearly one of the transformations that leave a surface one of
// heights, so the most of it that is left is a third.
static void integrable_lights(void **state)
{
    (void)state;
    static const double most[] = {[TURNED] = 0.05, [TILTED] = 0.4, [STRETCHED] = 0.1, [EACH] = 0.3};
    const struct bump s = {0};
    for (int e = TEST_SANITIZED ? EACH : TURNED; e <= EACH; e++) {
        double curl[2];
        const double plain = refined_error(&s, e, false, NULL);
        const double better = refined_error(&s, e, true, curl);
        if (!(better < most[e] && plain > (e == EACH ? 0.3 : 0.95) && curl[1] < 0.05 * curl[0]))
            fail_msg("error %d: %g of it is left, %g without integrability; curl %g, %g", e, better,
                     plain, curl[0], curl[1]);
    }
}

// Lights that a plane or a glossy surface does not determine stay as they are: they became 20 times
// and 1.4 times as wrong.
static void undetermined_lights_stay(void **state)
{
    (void)state;
    const struct bump plane = {.flat = true, .normal_of_plane = {0.1, 0.2, 1.0}, .gloss = 0.01};
    const struct bump glossy = {.shine = 0.3};
    for (int integrable = TEST_SANITIZED ? 1 : 0; integrable < 2; integrable++) {
        CHECK_NEAR(refined_error(&plane, EACH, integrable, NULL), 1.0, 1e-6);
        CHECK_NEAR(refined_error(&glossy, EACH, integrable, NULL), 1.0, 1e-6);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_without_outliers),
        cmocka_unit_test(outliers_are_left_out),
        cmocka_unit_test(near_lights),
        cmocka_unit_test(lamps_at_unequal_distances),
        cmocka_unit_test(too_few_lights),
        cmocka_unit_test(height_of_the_bump),
        cmocka_unit_test(steps_are_kept),
        cmocka_unit_test(confidence_counts),
        cmocka_unit_test(wide_shapes_keep_their_height),
        cmocka_unit_test(cosine_transform),
        cmocka_unit_test(refined_lights),
        cmocka_unit_test(refined_brightness),
        cmocka_unit_test(refined_power_of_near_lamps),
        cmocka_unit_test(integrable_lights),
        cmocka_unit_test(undetermined_lights_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
