// test_jnd.c - just noticeable differences against closed forms
#include "test.h"

#include "image/compare/jnd.h"
#include "image/compare/sight.h"

static struct relume_image grey(int width, int height, double value)
{
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, width, height, 3));
    for (int i = 0; i < 3 * width * height; i++)
        image.data[i] = (float)value;
    return image;
}

// Cosines across that are even at the borders.
static void add_cosine(struct relume_image *image, double cycles_per_pixel, double amplitude)
{
    for (int i = 0; i < image->width * image->height; i++)
        for (int c = 0; c < 3; c++)
            image->data[3 * i + c] +=
                (float)(amplitude * cos(2 * M_PI * cycles_per_pixel * (i % image->width + 0.5)));
}

// Guthe 2008, Tab. 10.1: what its sums give.
static void test_sensitivity(void **state)
{
    (void)state;
    const enum relume_opponent w = RELUME_OPPONENT_WHITE, r = RELUME_OPPONENT_RED;
    CHECK_NEAR(relume_jnd_sensitivity(w, 0.0), 1.872, 5e-4);
    CHECK_NEAR(relume_jnd_sensitivity(w, 3.43), 2.224, 5e-4);
    CHECK_NEAR(relume_jnd_sensitivity(w, 10.0), 0.793, 5e-4);
    CHECK_NEAR(relume_jnd_sensitivity(w, 20.0), 0.023, 5e-4);
    CHECK_NEAR(relume_jnd_sensitivity(r, 0.0), 0.516, 5e-4);
    CHECK_NEAR(relume_jnd_sensitivity(r, 10.0), 0.036, 5e-4);
    for (double f = 0.0; f < 40.0; f += 0.01)
        assert_true(relume_jnd_sensitivity(w, f) <= relume_jnd_sensitivity(w, 3.43) + 1e-5);
    CHECK_NEAR(relume_jnd_finest(w, relume_jnd_sensitivity(w, 12.0)), 12.0, 1e-6);
    CHECK_NEAR(relume_jnd_finest(r, relume_jnd_sensitivity(r, 5.0)), 5.0, 1e-6);
    CHECK_NEAR(relume_jnd_finest(w, 3.0), 0.0, 0.0);
}

static void test_opponent(void **state)
{
    (void)state;
    double a[3], b[3];
    // a grey 1 % brighter by daylight: each cone one step, channels the sums of their rows
    relume_jnd_opponent(a, (const double[]){0.5, 0.5, 0.5}, 1e7);
    relume_jnd_opponent(b, (const double[]){0.505, 0.505, 0.505}, 1e7);
    const double step = 100.0 * log(1.01);
    CHECK_NEAR(b[0] - a[0], 0.790 * step, 1e-4);
    CHECK_NEAR(b[1] - a[1], 0.046 * step, 1e-4);
    CHECK_NEAR(b[2] - a[2], 0.345 * step, 1e-4);
    // in the dark differences vanish
    relume_jnd_opponent(a, (const double[]){0.0, 0.0, 0.0}, 200.0);
    relume_jnd_opponent(b, (const double[]){1e-6, 1e-6, 1e-6}, 200.0);
    CHECK_NEAR(b[0], a[0], 0.02);
    relume_jnd_opponent(b, (const double[]){NAN, -1.0, 0.0}, 200.0);
    CHECK_NEAR(b[0], a[0], 1e-9);
}

static void test_threshold(void **state)
{
    (void)state;
    CHECK_NEAR(relume_jnd_threshold(0.0), 1.0, 0.0);
    // k1 (k2 m)^s is 1 near m = 1 and grows by 10^0.7 with each decade
    CHECK_NEAR(relume_jnd_threshold(1.0), pow(2.0, 0.25), 2e-3);
    CHECK_NEAR(relume_jnd_threshold(1e4) / relume_jnd_threshold(1e3), pow(10.0, 0.7), 1e-3);
}

static void test_bands(void **state)
{
    (void)state;
    for (double x = -50.0; x < 50.0; x += 1.37)
        for (double y = -50.0; y < 50.0; y += 2.11) {
            double bands = 0.0, directions = 0.0;
            for (int k = 0; k < SIGHT_BANDS; k++)
                bands += sight_band_share(k, x, y);
            for (int k = 0; k < SIGHT_DIRECTIONS; k++) {
                directions += sight_direction_share(k, x, y);
                CHECK_NEAR(sight_direction_share(k, -x, -y), sight_direction_share(k, x, y), 1e-9);
            }
            CHECK_NEAR(bands, 1.0, 1e-12);
            CHECK_NEAR(directions, 1.0, 1e-12);
        }
}

// A grating of amplitude A on the scale is A C(f) JND.
static void test_grating(void **state)
{
    (void)state;
    static const double cycles[] = {1.0 / 64, 1.0 / 32, 1.0 / 10, 1.0 / 4};
    for (int i = 0; i < 4; i++) {
        struct relume_image even = grey(128, 64, 0.3), grating = grey(128, 64, 0.3), map;
        struct relume_jnd d;
        double high[3], low[3];
        add_cosine(&grating, cycles[i], 0.003);
        relume_jnd_opponent(high, (const double[]){0.303, 0.303, 0.303}, 200.0);
        relume_jnd_opponent(low, (const double[]){0.297, 0.297, 0.297}, 200.0);
        const double want = 0.5 * (high[0] - low[0]) * relume_jnd_sensitivity(0, 32.0 * cycles[i]) *
                            cos(M_PI * cycles[i]);  // of the pixel nearest to the crest
        CHECK_OK(relume_image_jnd(&d, &map, &grating, &even,
                                  relume_jnd_params(.pixels_per_degree = 32)));
        CHECK_NEAR(d.max, want, 0.03 * want + 2e-3);
        CHECK_NEAR((double)map.data[0], d.max, 0.05 * d.max + 2e-3);
        assert_int_equal(d.pixels, 128 * 64);
        relume_image_destroy(&map);
        relume_image_destroy(&even);
        relume_image_destroy(&grating);
    }
}

// What a strong pattern of that fineness hides, and one that is far coarser does not.
static void test_masking(void **state)
{
    (void)state;
    double seen[3];
    for (int i = 0; i < 3; i++) {
        struct relume_image a = grey(128, 128, 0.3), b;
        struct relume_jnd d;
        if (i)
            add_cosine(&a, i == 1 ? 1.0 / 8 : 1.0 / 64, 0.15);
        b = grey(128, 128, 0.0);
        memcpy(b.data, a.data, 3 * sizeof *b.data * 128 * 128);
        for (int k = 0; k < 128 * 128; k++)  // across the masker, of its fineness
            for (int c = 0; c < 3; c++)
                b.data[3 * k + c] *= 1.0f + 0.02f * (float)cos(2 * M_PI * (k / 128 + 0.5) / 8);
        CHECK_OK(relume_image_jnd(&d, NULL, &b, &a, relume_jnd_params(.pixels_per_degree = 32)));
        seen[i] = d.mean;
        relume_image_destroy(&a);
        relume_image_destroy(&b);
    }
    assert_true(seen[0] > 1.0);
    assert_true(seen[1] < 0.25 * seen[0]);
    assert_true(seen[2] > 0.8 * seen[0]);
}

// One step is seen by half of all looks; 4 cycles per degree are one band and one direction.
static void test_vdp(void **state)
{
    (void)state;
    struct relume_image even = grey(128, 128, 0.3), grating = grey(128, 128, 0.3), map;
    struct relume_vdp v;
    double high[3], low[3];
    CHECK_OK(relume_image_vdp(&v, NULL, &even, &even, NULL));
    CHECK_NEAR(v.mean, 0.0, 0.0);
    relume_jnd_opponent(high, (const double[]){0.3003, 0.3003, 0.3003}, 200.0);
    relume_jnd_opponent(low, (const double[]){0.3, 0.3, 0.3}, 200.0);
    const double one = 0.0003 / ((high[0] - low[0]) * relume_jnd_sensitivity(0, 4.0));
    add_cosine(&grating, 1.0 / 16, one / cos(M_PI / 16));
    CHECK_OK(
        relume_image_vdp(&v, &map, &grating, &even, relume_jnd_params(.pixels_per_degree = 64)));
    CHECK_NEAR((double)map.data[128 * 64], 0.5, 0.02);
    CHECK_NEAR(v.p75, 0.0, 0.0);
    relume_image_destroy(&map);
    add_cosine(&grating, 1.0 / 16, one / cos(M_PI / 16));
    CHECK_OK(
        relume_image_vdp(&v, NULL, &grating, &even, relume_jnd_params(.pixels_per_degree = 64)));
    // of the crests 2 and 1.7 steps are nearly always seen, 1.1 and 0.4 are not
    CHECK_NEAR(v.p75, 0.5, 0.01);
    CHECK_NEAR(v.p95, 0.5, 0.01);
    relume_image_destroy(&even);
    relume_image_destroy(&grating);
}

static void test_colours(void **state)
{
    (void)state;
    static const double planted[3][3] = {{0.9, 0.1, 0.05}, {-0.1, 1.2, 0.0}, {0.02, 0.2, 0.7}};
    struct relume_image a = grey(20, 20, 0), b = grey(20, 20, 0), flat = grey(20, 20, 0.2);
    uint32_t seed = 5;
    double got[3][3];
    for (int i = 0; i < 3 * 400; i++)
        a.data[i] = b.data[i] = (float)test_uniform(&seed);
    CHECK_OK(relume_colours_apply(&b, planted));
    CHECK_OK(relume_colours_fit(got, &a, &b, NULL));
    for (int i = 0; i < 9; i++)
        CHECK_NEAR(got[i / 3][i % 3], planted[i / 3][i % 3], 1e-5);
    CHECK_OK(relume_colours_fit(got, &flat, &flat, NULL));
    CHECK_NEAR(got[0][0] + got[0][1] + got[0][2], 1.0, 1e-5);
    memset(flat.data, 0, 400 * 3 * sizeof *flat.data);
    assert_int_equal(relume_colours_fit(got, &flat, &a, NULL), RELUME_EUNFIT);
    relume_image_destroy(&a);
    relume_image_destroy(&b);
    relume_image_destroy(&flat);
}

static void test_refused(void **state)
{
    (void)state;
    struct relume_image a = grey(9, 5, 0.5), b = grey(9, 6, 0.5), map;
    struct relume_jnd d;
    struct relume_vdp v;
    assert_int_equal(relume_image_jnd(&d, &map, &a, &b, NULL), RELUME_EINVAL);
    assert_null(map.data);
    assert_int_equal(relume_image_vdp(&v, NULL, &a, &a, relume_jnd_params(.pixels_per_degree = -1)),
                     RELUME_EINVAL);
    a.data[4] = NAN;  // as black
    a.data[9] = INFINITY;
    CHECK_OK(relume_image_jnd(&d, NULL, &a, &a, relume_jnd_params(.threads = 2)));
    CHECK_NEAR(d.max, 0.0, 0.0);
    b.height = 5;
    CHECK_OK(relume_image_jnd(&d, NULL, &a, &b, NULL));
    assert_true(isfinite(d.max) && d.max > 1.0);
    b.height = 6;
    relume_image_destroy(&a);
    a = grey(1, 1, 0.5);
    CHECK_OK(relume_image_jnd(&d, NULL, &a, &a, NULL));
    relume_image_destroy(&a);
    relume_image_destroy(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sensitivity), cmocka_unit_test(test_opponent),
        cmocka_unit_test(test_threshold),   cmocka_unit_test(test_bands),
        cmocka_unit_test(test_grating),     cmocka_unit_test(test_masking),
        cmocka_unit_test(test_vdp),         cmocka_unit_test(test_colours),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
