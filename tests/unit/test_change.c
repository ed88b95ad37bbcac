// test_change.c - the steps of a comparison over time, each on what is known: smoothing, what
// lights and exposures make, the smooth flow, places, and what is refused
#include "core/math/random.h"
#include "core/math/vec.h"
#include "material/change/flow.h"
#include "material/change/judge.h"
#include "material/change/smooth.h"
#include "test.h"

enum { WIDTH = 96, HEIGHT = 80, PIXELS = WIDTH * HEIGHT };

// A surface of waves: normals and colours at any place.
static void wave(float normal[3], float colour[3], double x, double y)
{
    const vec3 n =
        vec3_unit(vec3_of(0.4 * sin(0.31 * x + 0.1 * y), 0.4 * cos(0.27 * y - 0.05 * x), 1));
    const float rgb[3] = {(float)(0.4 + 0.2 * sin(0.23 * x)), (float)(0.4 + 0.2 * cos(0.19 * y)),
                          (float)(0.3 + 0.1 * sin(0.15 * (x + y)))};
    vec3_store(normal, n);
    colour_code(colour, rgb);
}

static struct surface make_surface(double shift_x, double shift_y)
{
    struct surface s = {.width = WIDTH, .height = HEIGHT};
    struct relume_image *const of[] = {&s.normal, &s.colour, &s.normal_noise, &s.colour_noise};
    for (int i = 0; i < 4; i++)
        CHECK_OK(relume_image_create(of[i], WIDTH, HEIGHT, 3));
    for (int i = 0; i < PIXELS; i++) {
        wave(s.normal.data + 3 * i, s.colour.data + 3 * i, i % WIDTH + shift_x,
             i / WIDTH + shift_y);
        for (int c = 0; c < 3; c++)
            s.normal_noise.data[3 * i + c] = s.colour_noise.data[3 * i + c] =
                i % 2 ? 1e-3f : -1e-3f;
    }
    return s;
}

static void test_colours_return(void **state)
{
    (void)state;
    const float rgb[3] = {0.7f, 0.2f, 0.05f};
    float code[3], back[3];
    colour_code(code, rgb);
    colour_linear(back, code);
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(back[c], rgb[c], 1e-6);
}

// A constant stays, unknown pixels neither count nor appear, and a point keeps its sum.
static void test_smoothing(void **state)
{
    (void)state;
    struct relume_image image, known;
    CHECK_OK(relume_image_create(&image, 40, 30, 2));
    CHECK_OK(relume_image_create(&known, 40, 30, 1));
    for (int i = 0; i < 1200; i++) {
        known.data[i] = i % 40 < 20 ? 1.0f : 0.0f;
        image.data[2 * i] = known.data[i] > 0.5f ? 3.0f : NAN;
    }
    image.data[2 * (15 * 40 + 10) + 1] = 1.0f;
    CHECK_OK(smooth_known(&image, &known, 1.5, 2));
    double sum = 0.0;
    for (int i = 0; i < 1200; i++) {
        CHECK_NEAR(image.data[2 * i], known.data[i] > 0.5f ? 3.0 : 0.0, 1e-5);
        sum += (double)image.data[2 * i + 1];
    }
    CHECK_NEAR(sum, 1.0, 1e-4);
    // exp(-1/(2 s^2)) beside the middle
    CHECK_NEAR(image.data[2 * (15 * 40 + 11) + 1] / image.data[2 * (15 * 40 + 10) + 1],
               exp(-0.5 / 2.25), 1e-4);
    relume_image_destroy(&image);
    relume_image_destroy(&known);
}

// Normals turned by 5 degrees and stretched, colours through other gains, a quarter of the picture
// something else: the level takes back all but that.
static void test_level(void **state)
{
    (void)state;
    struct surface a = make_surface(0, 0), b = make_surface(0, 0);
    struct place same = {.m = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    struct level level;
    const double c = cos(0.087), s = sin(0.087);
    for (int i = 0; i < PIXELS; i++) {
        float *n = b.normal.data + 3 * i, rgb[3];
        const vec3 v = vec3_unit(vec3_of(1.1 * (c * (double)n[0] - s * (double)n[1]),
                                         s * (double)n[0] + c * (double)n[1], (double)n[2]));
        vec3_store(n, i % 4 ? v : vec3_of(0.6, 0, 0.8));
        colour_linear(rgb, b.colour.data + 3 * i);
        for (int k = 0; k < 3; k++)
            rgb[k] *= (i % 4 ? 1.0f : 0.3f) * (0.5f + 0.2f * (float)k);
        colour_code(b.colour.data + 3 * i, rgb);
    }
    CHECK_OK(level_find(&level, &a, &b, &same, false, 1));
    level_apply(&level, &b, 1);
    for (int i = 1; i < PIXELS; i += 4)
        for (int k = 0; k < 3; k++) {
            CHECK_NEAR(b.normal.data[3 * i + k], a.normal.data[3 * i + k], 0.01);
            CHECK_NEAR(b.colour.data[3 * i + k], a.colour.data[3 * i + k], 0.01);
        }
    CHECK_NEAR(exp(3.0 * level.gain[0][0]), 2.0, 0.03);
    surface_free(&a);
    surface_free(&b);
}

// The flow finds a shift of 1.3 and -0.8 pixels that the homography has not.
static void test_flow(void **state)
{
    (void)state;
    struct surface a = make_surface(0, 0), b = make_surface(-1.3, 0.8);
    struct place place = {.m = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const struct level none = {.turn = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    double longest, at[2];
    CHECK_OK(flow_find(&place, &longest, &a, &b, &none, 2));
    place_of(at, &place, 48.0, 40.0);
    CHECK_NEAR(at[0], 49.3, 0.1);
    CHECK_NEAR(at[1], 39.2, 0.1);
    CHECK_NEAR(longest, hypot(1.3, 0.8), 0.3);
    place_free(&place);
    surface_free(&a);
    surface_free(&b);
}

static struct relume_change make_change(void)
{
    struct relume_change c = {.width = WIDTH, .height = HEIGHT};
    CHECK_OK(relume_image_create(&c.degrees, WIDTH, HEIGHT, 1));
    CHECK_OK(relume_image_create(&c.delta_e, WIDTH, HEIGHT, 1));
    CHECK_OK(relume_image_create(&c.significance, WIDTH, HEIGHT, 3));
    CHECK_OK(relume_image_create(&c.changed, WIDTH, HEIGHT, 3));
    CHECK_OK(relume_image_create(&c.gloss, WIDTH, HEIGHT, 1));
    return c;
}

static const struct relume_change_params usual = {
    .least_deg = 2, .least_de = 2, .false_share = 0.01, .threads = 2};

static void set_normal(struct surface *s, int x, int y, double degrees)
{
    float *n = s->normal.data + 3 * (y * WIDTH + x);
    const double a = degrees * 0.017453292519943295, c = cos(a), t = sin(a);
    vec3_store(n, vec3_of(c * (double)n[0] + t * (double)n[2], (double)n[1],
                          c * (double)n[2] - t * (double)n[0]));
}

// Noise of 0.5 degrees is no change; a square of 10 degrees among it is, and is measured.
static void test_judging(void **state)
{
    (void)state;
    for (int with = 0; with < 2; with++) {
        struct surface a = make_surface(0, 0), b = make_surface(0, 0);
        struct relume_change c = make_change();
        struct random draw = random_stream(5, 0, 0);
        for (int i = 0; i < 3 * PIXELS; i++) {
            const double sum = random_next(&draw) + random_next(&draw) + random_next(&draw) - 1.5;
            b.normal.data[i] += (float)(0.017 * sum);
            a.normal_noise.data[i] = (float)(0.017 * (random_next(&draw) - 0.5));
        }
        for (int y = 30; with && y < 40; y++)
            for (int x = 50; x < 60; x++)
                set_normal(&b, x, y, 10.0);
        CHECK_OK(judge(&c, &a, &b, &usual));
        CHECK_OK(places_find(&c, 16));
        assert_int_equal(c.known, PIXELS);
        assert_int_equal(c.places, with);
        assert_int_equal(c.colour, 0);
        if (with) {
            CHECK_NEAR(c.place[0].area, 100, 45);  // smoothed by a pixel, its border may count
            CHECK_NEAR(c.place[0].box.left, 50, 1.5);
            CHECK_NEAR(c.place[0].box.height, 10, 3);
            CHECK_NEAR(c.degrees.data[35 * WIDTH + 55], 10.0, 0.5);
        }
        relume_change_destroy(&c);
        surface_free(&a);
        surface_free(&b);
    }
}

// Pixels that touch by a corner are one place, small places vanish, larger ones come first.
static void test_places(void **state)
{
    (void)state;
    static const int at[][2] = {{3, 3},  {4, 4},  {5, 3},   {20, 9},
                                {21, 9}, {22, 9}, {22, 10}, {70, 70}};
    struct relume_change c = make_change();
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        float *to = c.changed.data + 3 * (at[i][1] * WIDTH + at[i][0]);
        to[i < 3] = to[2] = 1.0f;
        c.degrees.data[at[i][1] * WIDTH + at[i][0]] = 4.0f;
    }
    CHECK_OK(places_find(&c, 2));
    assert_int_equal(c.places, 2);
    assert_int_equal(c.place[0].area, 4);
    assert_int_equal(c.place[0].shape, 4);
    assert_int_equal(c.place[0].box.left, 20);
    assert_int_equal(c.place[0].box.width, 3);
    assert_int_equal(c.place[0].box.height, 2);
    CHECK_NEAR(c.place[0].deg, 4.0, 1e-6);
    assert_int_equal(c.place[1].colour, 3);
    assert_int_equal(c.area, 7);
    CHECK_NEAR(c.changed.data[3 * (70 * WIDTH + 70) + 2], 0.0, 0);
    relume_change_destroy(&c);
}

static void test_refused(void **state)
{
    (void)state;
    struct relume_change c;
    const struct relume_change_input none = {0};
    assert_int_equal(relume_change_find(&c, &none, &none, NULL), RELUME_EINVAL);
    assert_null(c.degrees.data);
    assert_int_equal(relume_change_find(&c, &none, &none, relume_change_params(.false_share = 0.7)),
                     RELUME_EINVAL);
    assert_int_equal(relume_change_write(&c, "nowhere", NULL), RELUME_EINVAL);
    relume_change_destroy(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_colours_return), cmocka_unit_test(test_smoothing),
        cmocka_unit_test(test_level),          cmocka_unit_test(test_flow),
        cmocka_unit_test(test_judging),        cmocka_unit_test(test_places),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
