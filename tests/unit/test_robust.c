// Fits that outliers do not pull: the coefficients that made the samples are known
#include "format/coder/coding.h"

#include "test.h"

#include <relume/format/coder.h>
#include <relume/image/directions.h>

enum { LIGHTS = 48, K = 6, STRAY = 9 };

static struct relume_vec3 lights[LIGHTS];

static int setup(void **state)
{
    (void)state;
    return relume_directions_make(lights, LIGHTS, relume_pattern_find("hammersley"),
                                  relume_directions_params(.hemisphere = true)) != RELUME_OK;
}

static relume_coder *create(const struct relume_basis *basis, bool robust)
{
    relume_coder *c;
    CHECK_OK(relume_coder_create(&c, basis, lights, LIGHTS,
                                 relume_coder_params(.coefficients = basis->fit_count(9, LIGHTS),
                                                     .hemispherical = true, .ridge = 1e-12,
                                                     .robust = robust)));
    return c;
}

// The largest difference between the values that `planes` give and the true ones.
static double worst(const relume_coder *c, const float *planes, float (*truth)[3])
{
    const struct relume_coder_info *info = relume_coder_info(c);
    float weights[3 * 16], constant[3];
    double most = 0.0;
    for (int i = 0; i < LIGHTS; i++) {
        relume_coder_weights(c, lights[i], weights, constant);
        for (int channel = 0; channel < 3; channel++) {
            double sum = 0.0;
            for (int k = 0; k < info->coefficients; k++)
                sum += (double)weights[k] * (double)planes[relume_coder_plane(info, k, channel)];
            most = fmax(most, fabs(sum - (double)truth[i][channel]));
        }
    }
    return most;
}

// A quadratic of the projected light, another one for each colour.
static void smooth(float (*samples)[3])
{
    for (int i = 0; i < LIGHTS; i++)
        for (int c = 0; c < 3; c++)
            samples[i][c] = (float)(0.4 + 0.2 * lights[i].x - 0.1 * (c + 1) * lights[i].y +
                                    0.15 * lights[i].x * lights[i].y);
}

static void test_outliers_do_not_pull(void **state)
{
    (void)state;
    float truth[LIGHTS][3], samples[LIGHTS][3], planes[3 * 16];
    smooth(truth);
    memcpy(samples, truth, sizeof truth);
    for (int i = 0; i < STRAY; i++)  // highlights and shadows
        for (int c = 0; c < 3; c++)
            samples[i * 5][c] = i % 2 ? 1.0f : 0.0f;
    double error[2];
    for (int robust = 0; robust < 2; robust++) {
        relume_coder *c = create(&relume_basis_ptm, robust);
        CHECK_OK(relume_coder_apply(c, &samples[0][0], 3, 1, planes, 1));
        error[robust] = worst(c, planes, truth);
        relume_coder_destroy(&c);
    }
    // the assumed values at the horizon (weight 1e-4) see the stray ones: below half an 8-bit step
    assert_true(error[0] > 0.05);
    assert_true(error[1] < 0.5 / 255);
}

// Where there is nothing to leave out, both fits reproduce the samples as closely as the assumed
// values at the horizon allow.
static void test_clean_samples_are_met(void **state)
{
    (void)state;
    float truth[LIGHTS][3], planes[3 * 16];
    smooth(truth);
    for (int robust = 0; robust < 2; robust++) {
        relume_coder *c = create(&relume_basis_ptm, robust);
        CHECK_OK(relume_coder_apply(c, &truth[0][0], 3, 1, planes, 1));
        assert_true(worst(c, planes, truth) < 1e-3);
        relume_coder_destroy(&c);
    }
}

static void test_refused_where_nothing_is_fitted(void **state)
{
    (void)state;
    relume_coder *c;
    assert_int_equal(relume_coder_create(&c, &relume_basis_table, lights, LIGHTS,
                                         relume_coder_params(.robust = true)),
                     RELUME_EINVAL);
    assert_null(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_outliers_do_not_pull),
        cmocka_unit_test(test_clean_samples_are_met),
        cmocka_unit_test(test_refused_where_nothing_is_fitted),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
