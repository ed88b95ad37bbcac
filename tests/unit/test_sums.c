// test_sums.c - tests of src/format/coder/sums.h: sums over all lights, of which some are picked,
// are those of the samples of these lights
#include "test.h"

#include "format/coder/sums.h"

enum { LIGHTS = 7, PIXELS = 700, SOME = 4 };
static const int some[SOME] = {6, 0, 3, 2};
static float data[LIGHTS * PIXELS * 3], picked[SOME * PIXELS * 3];

static int setup(void **state)
{
    uint32_t seed = 11;
    (void)state;
    for (size_t i = 0; i < sizeof data / sizeof *data; i++)
        data[i] = (float)test_uniform(&seed) + 0.1f * (float)(i % 5);
    for (int k = 0; k < SOME; k++)
        memcpy(picked + k * PIXELS * 3, data + some[k] * PIXELS * 3, PIXELS * 3 * sizeof *data);
    return 0;
}

// Sums of 2100 products in another order: 2100 * 2^-53 of values below 3.
static void same(const double *got, const double *want, size_t n)
{
    for (size_t i = 0; i < n; i++)
        CHECK_NEAR(got[i], want[i], 1e-12);
}

static void test_some_of_the_lights(void **state)
{
    const struct relume_samples all = {.lights = LIGHTS, .pixels = PIXELS, .data = data};
    const struct relume_samples few = {.lights = SOME, .pixels = PIXELS, .data = picked};
    struct relume_sample_sums sums = {0}, own = {0}, part;
    (void)state;
    assert_int_equal(sample_sums_make(&sums, &all, false, 2), RELUME_OK);
    assert_null(sums.covariance);  // not asked for
    assert_int_equal(sample_sums_make(&sums, &all, true, 1), RELUME_OK);
    assert_int_equal(sample_sums_make(&own, &few, true, 1), RELUME_OK);
    assert_int_equal(sample_sums_pick(&part, &sums, some, SOME), RELUME_OK);
    same(part.gram, own.gram, SOME * SOME);
    same(part.mean, own.mean, 3 * SOME);
    same(part.covariance, own.covariance, 9 * SOME * SOME);
    sample_sums_free(&sums);
    sample_sums_free(&own);
    sample_sums_free(&part);
}

// What is known is taken, whatever the samples are.
static void test_known_sums(void **state)
{
    const struct relume_samples all = {.lights = LIGHTS, .pixels = PIXELS, .data = data};
    struct relume_sample_sums sums = {0};
    double gram[LIGHTS * LIGHTS], mean[3 * LIGHTS], covariance[9 * LIGHTS * LIGHTS];
    (void)state;
    assert_int_equal(sample_sums_make(&sums, &all, true, 1), RELUME_OK);
    const struct relume_samples known = {.lights = LIGHTS, .pixels = PIXELS, .sums = &sums};
    assert_int_equal(samples_gram(gram, &known, 1), RELUME_OK);
    assert_int_equal(samples_covariance(mean, covariance, &known, 1), RELUME_OK);
    assert_memory_equal(gram, sums.gram, sizeof gram);
    assert_memory_equal(mean, sums.mean, sizeof mean);
    assert_memory_equal(covariance, sums.covariance, sizeof covariance);
    sample_sums_free(&sums);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_some_of_the_lights),
        cmocka_unit_test(test_known_sums),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
