// The virtual gonioreflectometer: a flat matte sample in closed form, reciprocity, ground truth.
#include "test.h"

#include "core/base/half.h"
#include "core/math/vec.h"
#include "material/btf/values.h"

#include <relume/world/scene.h>

enum { DIRECTIONS = 19, SIZE = 10 };

static relume_btf *measure(const char *name, int samples, int bounces, uint64_t seed, int threads)
{
    static vec3 d[DIRECTIONS];
    relume_btf_set_directions(relume_btf_set_find("coarse"), d);
    relume_btf *btf;
    CHECK_OK(relume_btf_synth(
        &btf, relume_btf_material_find(name),
        relume_btf_synth_params(.size = SIZE, .samples = samples, .bounces = bounces, .view = d,
                                .views = DIRECTIONS, .light = d, .lights = DIRECTIONS, .seed = seed,
                                .threads = threads)));
    return btf;
}

static double mean(const relume_btf *btf, int view, int light, int c)
{
    const uint16_t *p = relume_btf_picture(btf, view, light);
    double sum = 0.0;
    for (int i = 0; i < SIZE * SIZE; i++)
        sum += (double)float_from_half(p[3 * i + c]);
    return sum / (SIZE * SIZE);
}

// Seen as a whole the periodic sample is a flat surface with a BRDF: values over n.l are equal when
// light and eye change places (Helmholtz), whatever the relief shadows and hides.
static void check_reciprocity(const relume_btf *btf, double tolerance)
{
    const struct relume_vec3 *d = relume_btf_info(btf)->light;
    double off = 0.0, all = 0.0;
    for (int a = 0; a < DIRECTIONS; a++)
        for (int b = 0; b < a; b++) {
            const double there = mean(btf, a, b, 1) / d[b].z, back = mean(btf, b, a, 1) / d[a].z;
            off += fabs(there - back);
            all += 0.5 * (there + back);
        }
    if (!(off < tolerance * all))
        fail_msg("%g of the light is not reciprocal; expected %g", off / all, tolerance);
}

// Almost flat, almost matte: the paper between the flowers shows albedo * n.l from the front.
static void check_paper(const relume_btf *btf)
{
    const struct relume_vec3 *d = relume_btf_info(btf)->light;
    const double straight = (double)float_from_half(relume_btf_picture(btf, 0, 0)[1]);
    double ring = 0.0;  // around the pole, so that the grain's tilt is no matter
    for (int l = 1; l < 7; l++)
        ring += (double)float_from_half(relume_btf_picture(btf, 0, l)[1]) / 6.0;
    CHECK_NEAR(ring, straight * d[1].z, 0.03 * straight);  // the weak coat: f0 = 0.02
}

static void test_wallpaper(void **state)
{
    (void)state;
    relume_btf *btf = measure("wallpaper", 8, -1, 0, 2);
    check_reciprocity(btf, 0.02);
    check_paper(btf);
    relume_btf_destroy(&btf);
}

static void check_truth(const struct relume_btf_info *info)
{
    assert_int_equal(info->relief.channels, 1);
    assert_int_equal(info->normals.channels, 3);
    double sum = 0.0, deep = 0.0, tilt = 0.0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float *n = info->normals.data + 3 * i;
        sum += (double)info->relief.data[i];
        deep = fmax(deep, fabs((double)info->relief.data[i]));
        tilt = fmax(tilt, fabs((double)n[0]));
        CHECK_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1.0, 1e-5);
    }
    CHECK_NEAR(sum / (SIZE * SIZE), 0.0, 1e-6);  // heights are over their mean
    assert_true(deep > 0.005 && deep < 0.1);
    assert_true(tilt > 0.2);
}

static void test_corduroy(void **state)
{
    (void)state;
    relume_btf *btf = measure("corduroy", 8, 1, 3, 1), *again = measure("corduroy", 8, 1, 3, 3);
    check_reciprocity(btf, 0.03);  // 800 rays a view: 1 / sqrt(800) of the contrast
    check_truth(relume_btf_info(btf));
    for (int v = 0; v < DIRECTIONS; v++)
        assert_memory_equal(relume_btf_picture(btf, v, 3), relume_btf_picture(again, v, 3),
                            SIZE * SIZE * 6);
    relume_btf_destroy(&btf);
    relume_btf_destroy(&again);
}

// RMS of what two measurements differ by, in parts of the values, once the mean over views of each
// texel and light is taken off: what one view has that the others have not.
static double noise(const relume_btf *a, const relume_btf *b)
{
    double off = 0.0, all = 0.0;
    for (int l = 0; l < DIRECTIONS; l++)
        for (int i = 0; i < SIZE * SIZE * 3; i++) {
            double d[DIRECTIONS], sum = 0.0;
            for (int v = 0; v < DIRECTIONS; v++) {
                const double x = (double)float_from_half(relume_btf_picture(a, v, l)[i]);
                sum += d[v] = x - (double)float_from_half(relume_btf_picture(b, v, l)[i]);
                all += x * x;
            }
            for (int v = 0; v < DIRECTIONS; v++)
                off += (d[v] - sum / DIRECTIONS) * (d[v] - sum / DIRECTIONS);
        }
    return sqrt(off / all);
}

// Three rays in a texel leave a third of a ray's variance, a tent over sixteen pixels of one ray
// each 1 / 10.2, of four rays each (the truth here) 1 / 40.8: together a ratio of 0.585.
static void test_resampling(void **state)
{
    (void)state;
    relume_btf *truth = measure("stone", 16, -1, 0, 2);
    relume_btf *four = measure("stone", 4, -1, 0, 2), *three = measure("stone", 3, -1, 0, 2);
    assert_true(noise(four, truth) < 0.7 * noise(three, truth));
    relume_btf_destroy(&truth);
    relume_btf_destroy(&four);
    relume_btf_destroy(&three);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wallpaper),
        cmocka_unit_test(test_corduroy),
        cmocka_unit_test(test_resampling),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
