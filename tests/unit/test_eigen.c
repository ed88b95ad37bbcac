// Eigenimages: both ways of finding them, and what comes back of logarithms of light
#include "test.h"

#include "format/coder/basis.h"
#include "format/coder/coding.h"

#include <math.h>
#include <string.h>

enum { LIGHTS = 30, PIXELS = 500, RANK = 4 };
static const struct relume_transfer curve = {.curve = RELUME_CURVE_LOG, .gamma = 1e-3f};

static struct relume_vec3 lights[LIGHTS];
static float data[LIGHTS * PIXELS * 3];
static const struct relume_samples samples = {.lights = LIGHTS, .pixels = PIXELS, .data = data};

static int setup(void **state)
{
    (void)state;
    return relume_directions_make(lights, LIGHTS, relume_pattern_find("hammersley"), NULL) != 0;
}

// Codes that are sums of `rank` pictures, weaker and weaker, and what else `noise` adds.
static void make(int rank, double noise)
{
    static double picture[LIGHTS][PIXELS * 3];
    double weight[LIGHTS];
    uint32_t seed = 11;
    memset(data, 0, sizeof data);
    for (int k = 0; k < rank; k++) {
        for (int i = 0; i < PIXELS * 3; i++)
            picture[k][i] = test_uniform(&seed) * pow(0.6, k);
        for (int i = 0; i < LIGHTS; i++)
            weight[i] = test_uniform(&seed) - (k ? 0.5 : 0.0);
        for (int i = 0; i < LIGHTS; i++)
            for (int x = 0; x < PIXELS * 3; x++)
                data[i * PIXELS * 3 + x] += (float)(weight[i] * picture[k][x]);
    }
    for (size_t i = 0; i < sizeof data / sizeof *data; i++)
        data[i] += (float)(noise * test_uniform(&seed));
}

// `delaunay` keeps what the photographed lights say; others may smooth.
static relume_coder *learn(int count)
{
    relume_coder *c;
    CHECK_OK(relume_coder_create(
        &c, &relume_basis_eigen, lights, LIGHTS,
        relume_coder_params(.coefficients = count, .samples = &samples,
                            .interpolant = relume_interpolant_find("delaunay"))));
    return c;
}

// The largest difference of light between what went in and what comes back at the photographed
// lights, relative to the light and delta.
static double worst(const relume_coder *c)
{
    const struct relume_coder_info *info = relume_coder_info(c);
    const size_t k = (size_t)info->coefficients;
    static float planes[3 * LIGHTS * PIXELS], weights[3 * LIGHTS];
    double most = 0.0;
    assert_int_equal(info->planes, 3 * k);
    CHECK_OK(relume_coder_apply(c, data, PIXELS * 3, PIXELS, planes, PIXELS));
    for (size_t i = 0; i < LIGHTS; i++) {
        float constant[3];
        relume_coder_weights(c, lights[i], weights, constant);
        for (size_t x = 0; x < PIXELS * 3; x++) {
            double code = (double)constant[x % 3];
            for (size_t j = 0; j < k; j++)
                code += (double)weights[j] * (double)planes[(3 * j + x % 3) * PIXELS + x / 3];
            const double got = (double)relume_transfer_decode(curve, (float)code);
            const double want = (double)relume_transfer_decode(curve, data[i * PIXELS * 3 + x]);
            most = fmax(most, fabs(got - want) / (want + (double)curve.gamma));
        }
    }
    return most;
}

static void test_both_ways_agree(void **state)
{
    (void)state;
    enum { COUNT = 6 };
    double gram[COUNT * LIGHTS], steps[COUNT * LIGHTS], again[COUNT * LIGHTS];
    make(10, 1e-3);
    CHECK_OK(eigen_by_gram(gram, COUNT, &samples, 1));
    CHECK_OK(eigen_by_steps(steps, COUNT, &samples, 1));
    CHECK_OK(eigen_by_steps(again, COUNT, &samples, 3));
    assert_memory_equal(steps, again, sizeof steps);
    for (int i = 0; i < COUNT * LIGHTS; i++)
        CHECK_NEAR(steps[i], gram[i], 1e-9);  // 24 of 30 steps: what is left of the space is noise
    // a light's weight times its eigenimage, pixel by pixel, in double precision: M g is orthogonal
    for (int a = 0; a < COUNT; a++)
        for (int b = 0; b < a; b++) {
            double sum = 0.0, size = 0.0;
            for (int x = 0; x < PIXELS * 3; x++) {
                double e[2] = {0.0, 0.0};
                for (int i = 0; i < LIGHTS; i++) {
                    e[0] += (double)data[i * PIXELS * 3 + x] * gram[a * LIGHTS + i];
                    e[1] += (double)data[i * PIXELS * 3 + x] * gram[b * LIGHTS + i];
                }
                sum += e[0] * e[1];
                size += e[1] * e[1];
            }
            CHECK_NEAR(sum / size, 0.0, 1e-10);
        }
}

// Codes are single precision, of which the exponential makes 7 times their error.
static void test_logarithms_of_low_rank_come_back(void **state)
{
    (void)state;
    make(RANK, 0.0);
    relume_coder *all = learn(RANK), *few = learn(RANK - 1);
    assert_true(worst(all) < 2e-5);
    assert_true(worst(few) > 1e-2);
    relume_coder_destroy(&all);
    relume_coder_destroy(&few);
}

// One term of 300 lights is found by steps; the coder is that of either way.
static void test_many_lights(void **state)
{
    (void)state;
    enum { MANY = 300, FEW = 50 };
    static struct relume_vec3 direction[MANY];
    static float value[MANY * FEW * 3];
    const struct relume_samples s = {.lights = MANY, .pixels = FEW, .data = value};
    double gram[MANY];
    uint32_t seed = 4;
    relume_coder *c;
    CHECK_OK(relume_directions_make(direction, MANY, relume_pattern_find("hammersley"), NULL));
    for (int i = 0; i < MANY * FEW * 3; i++)
        value[i] = (float)(test_uniform(&seed) + (i / (FEW * 3)) % 3);
    CHECK_OK(eigen_by_gram(gram, 1, &s, 1));
    CHECK_OK(relume_coder_create(&c, &relume_basis_eigen, direction, MANY,
                                 relume_coder_params(.coefficients = 1, .samples = &s)));
    for (int i = 0; i < MANY; i++)  // four steps: the next eigenvalue is a hundredth of the first
        CHECK_NEAR(relume_coder_info(c)->transform[i], gram[i], 1e-5);
    relume_coder_destroy(&c);
}

static void test_as_many_as_lights_are_exact(void **state)
{
    (void)state;
    make(20, 0.3);
    relume_coder *c = learn(LIGHTS), *usual = learn(0);
    assert_true(worst(c) < 2e-5);
    assert_int_equal(relume_coder_info(usual)->coefficients, 16);
    relume_coder_destroy(&c);
    relume_coder_destroy(&usual);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_both_ways_agree),
        cmocka_unit_test(test_logarithms_of_low_rank_come_back),
        cmocka_unit_test(test_many_lights),
        cmocka_unit_test(test_as_many_as_lights_are_exact),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
