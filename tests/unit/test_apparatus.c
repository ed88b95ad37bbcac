// What lens, sensor, lamp and rectification do to a photograph, each against its closed form.
#include "test.h"

#include "core/base/half.h"
#include "material/btf/values.h"
#include "world/stage/apparatus.h"

enum { SIZE = 32, TEXELS = SIZE * SIZE, MANY = 400 };

static const vec3 STRAIGHT = {0.0, 0.0, 1.0};

static apparatus *create(struct relume_btf_faults faults)
{
    apparatus *a;
    CHECK_OK(apparatus_create(&a, &faults, SIZE, 5, 1));
    assert_non_null(a);
    return a;
}

static void fill(float *texels, float value)
{
    for (int i = 0; i < 3 * TEXELS; i++)
        texels[i] = value;
}

static void point(float *texels)  // of light 1 in the middle
{
    fill(texels, 0.0f);
    for (int c = 0; c < 3; c++)
        texels[3 * (SIZE / 2 * SIZE + SIZE / 2) + c] = 1.0f;
}

// Sum, centre and covariance of one colour about the middle texel.
struct moments {
    double sum, x, y, xx, xy, yy;
};

static struct moments measure(const float *texels, int c)
{
    struct moments m = {0};
    for (int j = 0; j < SIZE; j++)
        for (int i = 0; i < SIZE; i++) {
            const double v = (double)texels[3 * (j * SIZE + i) + c];
            const double x = i - SIZE / 2, y = j - SIZE / 2;
            m.sum += v;
            m.x += v * x;
            m.y += v * y;
            m.xx += v * x * x;
            m.xy += v * x * y;
            m.yy += v * y * y;
        }
    return m;
}

// Half of the cosine doubles the spread in the direction of the tilt: 30 degrees from the u axis,
// which in a picture goes up.
static void test_blur(void **state)
{
    (void)state;
    const double blur = 1.2, cosine = 0.5, angle = M_PI / 6.0, flat = sqrt(1.0 - cosine * cosine);
    apparatus *a = create((struct relume_btf_faults){.blur = blur});
    float texels[3 * TEXELS];
    point(texels);
    apparatus_spoil(a, texels, (vec3){flat * cos(angle), flat * sin(angle), cosine}, 0, 0);
    const double along = blur * blur / (cosine * cosine), across = blur * blur;
    const double xx = along * 0.75 + across * 0.25, yy = along * 0.25 + across * 0.75;
    const double xy = -(along - across) * sqrt(3.0) / 4.0;
    for (int c = 0; c < 3; c++) {
        const struct moments m = measure(texels, c);  // sampling a Gaussian this wide loses 1e-6
        CHECK_NEAR(m.sum, 1.0, 1e-5);
        CHECK_NEAR(m.xx, xx, 1e-3 * xx);
        CHECK_NEAR(m.yy, yy, 1e-3 * yy);
        CHECK_NEAR(m.xy, xy, 1e-3 * xx);
    }
    apparatus_destroy(&a);
}

// The centre of a point moves by a normal deviate: of 400, the standard deviation is known to
// 1 / sqrt(800), here within four of its own.
static void test_shift(void **state)
{
    (void)state;
    apparatus *a = create((struct relume_btf_faults){.shift = 1.5});
    double x = 0.0, y = 0.0, xy = 0.0;
    for (int n = 0; n < MANY; n++) {
        float texels[3 * TEXELS];
        point(texels);
        apparatus_spoil(a, texels, STRAIGHT, (uint64_t)n, 0);
        const struct moments m = measure(texels, n % 3);
        CHECK_NEAR(m.sum, 1.0, 1e-6);
        x += m.x * m.x / MANY;
        y += m.y * m.y / MANY;
        xy += m.x * m.y / MANY;
    }
    CHECK_NEAR(sqrt(x), 1.5, 1.5 * 4.0 / sqrt(2.0 * MANY));
    CHECK_NEAR(sqrt(y), 1.5, 1.5 * 4.0 / sqrt(2.0 * MANY));
    CHECK_NEAR(xy, 0.0, 2.25 * 4.0 / sqrt(MANY));
    apparatus_destroy(&a);
}

static void test_flicker(void **state)
{
    (void)state;
    apparatus *a = create((struct relume_btf_faults){.flicker = 0.1});
    double variance = 0.0;
    for (int n = 0; n < MANY; n++) {
        float texels[3 * TEXELS];
        fill(texels, 0.5f);
        apparatus_spoil(a, texels, STRAIGHT, (uint64_t)n, 0);
        assert_true(texels[0] == texels[3 * TEXELS - 1]);  // the whole photograph by one factor
        variance += pow((double)texels[0] / 0.5 - 1.0, 2) / MANY;
    }
    CHECK_NEAR(sqrt(variance), 0.1, 0.1 * 4.0 / sqrt(2.0 * MANY));
    apparatus_destroy(&a);
}

// Variance in proportion to the light, and to how much smaller a texel looks.
static void test_noise(void **state)
{
    (void)state;
    const struct {
        double light, cosine;
    } cases[] = {{1.0, 1.0}, {0.25, 1.0}, {0.25, 0.25}};
    apparatus *a = create((struct relume_btf_faults){.noise = 0.02});
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const double cosine = cases[k].cosine;
        float texels[3 * TEXELS];
        fill(texels, (float)cases[k].light);
        apparatus_spoil(a, texels, (vec3){sqrt(1.0 - cosine * cosine), 0.0, cosine}, k, 0);
        double mean = 0.0, variance = 0.0;
        for (int i = 0; i < 3 * TEXELS; i++) {
            const double off = (double)texels[i] - cases[k].light;
            mean += off / (3 * TEXELS);
            variance += off * off / (3 * TEXELS);
        }
        const double expected = 0.02 * sqrt(cases[k].light / cosine);
        CHECK_NEAR(sqrt(variance), expected, expected * 4.0 / sqrt(2.0 * 3 * TEXELS));
        CHECK_NEAR(mean, 0.0, expected * 4.0 / sqrt(3.0 * TEXELS));
    }
    apparatus_destroy(&a);
}

static relume_btf *synth(struct relume_btf_faults faults, int threads)
{
    vec3 d[19];
    relume_btf_set_directions(relume_btf_set_find("coarse"), d);
    relume_btf *btf;
    CHECK_OK(relume_btf_synth(&btf, relume_btf_material_find("wallpaper"),
                              relume_btf_synth_params(.size = 9, .view = d, .views = 19, .light = d,
                                                      .lights = 19, .threads = threads,
                                                      .faults = faults)));
    return btf;
}

// A goniometer with faults: the same bytes for any number of threads, and other ones than without.
static void test_goniometer(void **state)
{
    (void)state;
    const struct relume_btf_faults faults = {0.7, 0.01, 0.3, 0.02};
    relume_btf *one = synth(faults, 1), *three = synth(faults, 3);
    relume_btf *none = synth((struct relume_btf_faults){0}, 2);
    const size_t bytes = 9 * 9 * 6;
    for (int v = 0; v < 19; v++) {
        const uint16_t *picture = relume_btf_picture(one, v, 18 - v);
        assert_memory_equal(picture, relume_btf_picture(three, v, 18 - v), bytes);
        assert_memory_not_equal(picture, relume_btf_picture(none, v, 18 - v), bytes);
    }
    relume_btf_destroy(&one);
    relume_btf_destroy(&three);
    relume_btf_destroy(&none);
}

static void test_refused(void **state)
{
    (void)state;
    const struct relume_btf_faults wrong[] = {
        {.blur = -1.0},
        {.noise = 2.0},
        {.shift = 101.0},
        {.flicker = (double)NAN},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        relume_btf *btf;
        assert_int_equal(relume_btf_synth(&btf, relume_btf_material_find("stone"),
                                          relume_btf_synth_params(.size = 4, .faults = wrong[k])),
                         RELUME_EINVAL);
        assert_null(btf);
    }
    apparatus *a;
    CHECK_OK(apparatus_create(&a, &(struct relume_btf_faults){0}, SIZE, 0, 1));
    assert_null(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_blur),       cmocka_unit_test(test_shift),
        cmocka_unit_test(test_flicker),    cmocka_unit_test(test_noise),
        cmocka_unit_test(test_goniometer), cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
