// test_pca.c - principal components against what defines them, in double precision
#include "test.h"

#include "format/coder/pca.h"

enum { LIGHTS = 12, DIM = 3 * LIGHTS, PIXELS = 300 };

static struct relume_vec3 lights[LIGHTS];
static float data[LIGHTS * PIXELS * 3];
static const struct relume_samples samples = {.lights = LIGHTS, .pixels = PIXELS, .data = data};

// Lambertian pixels with a lobe and noise: full rank, with a clear order of importance.
static int setup(void **state)
{
    (void)state;
    uint32_t seed = 11;
    if (relume_directions_make(lights, LIGHTS, relume_pattern_find("hammersley"),
                               relume_directions_params(.hemisphere = true)))
        return 1;
    for (size_t x = 0; x < PIXELS; x++) {
        const vec3 n = test_direction(&seed), m = test_direction(&seed);
        for (size_t i = 0; i < LIGHTS; i++)
            for (size_t c = 0; c < 3; c++)
                data[(i * PIXELS + x) * 3 + c] =
                    (float)((0.3 + 0.2 * (double)c) * fmax(vec3_dot(n, lights[i]), 0.0) +
                            0.5 * pow(fmax(vec3_dot(m, lights[i]), 0.0), 8.0) +
                            0.02 * test_uniform(&seed));
    }
    return 0;
}

static relume_coder *create(int k, const char *interpolant)
{
    relume_coder *c;
    CHECK_OK(relume_coder_create(
        &c, &relume_basis_pca, lights, LIGHTS,
        relume_coder_params(.coefficients = k, .hemispherical = true, .samples = &samples,
                            .interpolant = relume_interpolant_find(interpolant))));
    return c;
}

static double sample(size_t pixel, size_t j)  // as [channel][light]
{
    return (double)data[((j % LIGHTS) * PIXELS + pixel) * 3 + j / LIGHTS];
}

// What is left of all pixels after K components, at the captured lights.
static double residual(const relume_coder *c)
{
    const struct relume_coder_info *info = relume_coder_info(c);
    const int k = info->coefficients;
    static float planes[DIM * PIXELS];
    float w[3 * DIM], constant[3];
    double sum = 0.0;
    CHECK_OK(relume_coder_apply(c, data, 3 * PIXELS, PIXELS, planes, PIXELS));
    for (size_t i = 0; i < LIGHTS; i++) {
        relume_coder_weights(c, lights[i], w, constant);
        for (size_t channel = 0; channel < 3; channel++)
            for (size_t x = 0; x < PIXELS; x++) {
                double v = (double)constant[channel];
                for (int p = 0; p < k; p++)
                    v += (double)w[(int)channel * k + p] * (double)planes[(size_t)p * PIXELS + x];
                const double d = v - sample(x, channel * LIGHTS + i);
                sum += d * d;
            }
    }
    return sum / PIXELS;
}

// Eigenvalues of the covariance by Jacobi's rotations, descending.
static void jacobi(double *values)
{
    static double a[DIM][DIM];
    double mean[DIM] = {0};
    for (size_t j = 0; j < DIM; j++)
        for (size_t x = 0; x < PIXELS; x++)
            mean[j] += sample(x, j) / PIXELS;
    for (size_t i = 0; i < DIM; i++)
        for (size_t j = 0; j < DIM; j++) {
            a[i][j] = 0.0;
            for (size_t x = 0; x < PIXELS; x++)
                a[i][j] += (sample(x, i) - mean[i]) * (sample(x, j) - mean[j]) / PIXELS;
        }
    for (int sweep = 0; sweep < 30; sweep++)
        for (int p = 0; p < DIM; p++)
            for (int q = p + 1; q < DIM; q++) {
                const double t = 0.5 * atan2(2.0 * a[p][q], a[q][q] - a[p][p]);
                const double c = cos(t), s = sin(t);
                for (int i = 0; i < DIM; i++) {
                    const double u = a[i][p], v = a[i][q];
                    a[i][p] = c * u - s * v;
                    a[i][q] = s * u + c * v;
                }
                for (int i = 0; i < DIM; i++) {
                    const double u = a[p][i], v = a[q][i];
                    a[p][i] = c * u - s * v;
                    a[q][i] = s * u + c * v;
                }
            }
    for (int i = 0; i < DIM; i++)
        values[i] = a[i][i];
    for (int i = 0; i < DIM; i++)
        for (int j = i + 1; j < DIM; j++)
            if (values[j] > values[i]) {
                const double t = values[i];
                values[i] = values[j];
                values[j] = t;
            }
}

// No K components leave less than the eigenvalues that follow (Eckart and Young); those that look
// at directions between the lights pay a little at the lights themselves.
static void test_residual_is_near_the_least(void **state)
{
    (void)state;
    double values[DIM];
    jacobi(values);
    for (int k = 1; k <= 9; k++) {
        double least = 0.0;
        for (int i = k; i < DIM; i++)
            least += values[i];
        relume_coder *c = create(k, "tps");
        const double left = residual(c);
        if (!(left >= least * (1.0 - 1e-4) && left <= 2.5 * least))
            fail_msg("%d components leave %.6g, at least %.6g", k, left, least);
        relume_coder_destroy(&c);
    }
}

// With C the covariance of the samples, C analysis_k = variance_k function_k: principal components
// in whatever metric. The metric's inverse, the sum of function_k function_k' over all k, is the
// same for each colour and mixes none.
static void test_stationary_in_one_metric_for_all_colours(void **state)
{
    (void)state;
    relume_coder *c = create(DIM, "chord");
    struct components all;
    double mean[DIM] = {0}, inverse[DIM][DIM] = {{0}}, size = 0.0;
    c->samples = &samples;
    CHECK_OK(components_find(&all, c));
    for (size_t j = 0; j < DIM; j++)
        for (size_t x = 0; x < PIXELS; x++)
            mean[j] += sample(x, j) / PIXELS;
    for (size_t k = 0; k < DIM; k++) {
        const double *a = all.analysis + k * DIM, *f = all.function + k * DIM;
        double score[PIXELS] = {0}, variance = 0.0;
        for (size_t x = 0; x < PIXELS; x++) {
            for (size_t j = 0; j < DIM; j++)
                score[x] += a[j] * (sample(x, j) - mean[j]);
            variance += score[x] * score[x] / PIXELS;
        }
        for (size_t j = 0; j < DIM; j++) {
            double moved = 0.0;
            for (size_t x = 0; x < PIXELS; x++)
                moved += (sample(x, j) - mean[j]) * score[x] / PIXELS;
            CHECK_NEAR(moved, variance * f[j], 1e-10);
            for (size_t i = 0; i < DIM; i++)
                inverse[i][j] += f[i] * f[j];
        }
    }
    for (int i = 0; i < DIM; i++)
        size = fmax(size, inverse[i][i]);
    for (int i = 0; i < DIM; i++)
        for (int j = 0; j < DIM; j++)
            CHECK_NEAR(inverse[i][j],
                       i / LIGHTS == j / LIGHTS ? inverse[i % LIGHTS][j % LIGHTS] : 0.0,
                       1e-9 * size);
    c->samples = NULL;
    components_destroy(&all);
    relume_coder_destroy(&c);
}

// Single precision: 36 terms of size 1.
static void test_all_components_are_the_identity(void **state)
{
    (void)state;
    static const char *const names[] = {"delaunay", "angular", "tps", "natural"};
    for (int i = 0; i < 4; i++) {
        relume_coder *c = create(DIM, names[i]);
        CHECK_NEAR(sqrt(residual(c) / DIM), 0.0, 5e-5);
        relume_coder_destroy(&c);
    }
}

// analysis_i . function_j = 1 where i = j, else 0: coefficients come back as themselves.
static void test_coefficients_come_back(void **state)
{
    (void)state;
    enum { K = 9 };
    relume_coder *c = create(K, "angular");
    const struct relume_coder_info *info = relume_coder_info(c);
    for (int i = 0; i < K; i++)
        for (int j = 0; j < K; j++) {
            double sum = 0.0;
            for (int channel = 0; channel < 3; channel++)
                for (int l = 0; l < LIGHTS; l++)
                    sum += (double)c->map[(i * 3 + channel) * LIGHTS + l] *
                           (double)info->transform[(channel * K + j) * LIGHTS + l];
            CHECK_NEAR(sum, i == j, 1e-5);
        }
    relume_coder_destroy(&c);
}

// The coefficients of the samples are uncorrelated, and their variance falls.
static void test_coefficients_are_uncorrelated(void **state)
{
    (void)state;
    enum { K = 9 };
    static float planes[K * PIXELS];
    relume_coder *c = create(K, "chord");
    double variance[K][K] = {{0}}, mean[K] = {0};
    CHECK_OK(relume_coder_apply(c, data, 3 * PIXELS, PIXELS, planes, PIXELS));
    for (int i = 0; i < K; i++)
        for (int x = 0; x < PIXELS; x++)
            mean[i] += (double)planes[i * PIXELS + x] / PIXELS;
    for (int i = 0; i < K; i++)
        for (int j = 0; j < K; j++)
            for (int x = 0; x < PIXELS; x++)
                variance[i][j] += ((double)planes[i * PIXELS + x] - mean[i]) *
                                  ((double)planes[j * PIXELS + x] - mean[j]) / PIXELS;
    for (int i = 0; i < K; i++) {
        CHECK_NEAR(mean[i], 0.0, 1e-5);
        assert_true(i == 0 || variance[i][i] <= variance[i - 1][i - 1] * (1.0 + 1e-6));
        for (int j = 0; j < i; j++)
            CHECK_NEAR(variance[i][j], 0.0, 1e-5 * variance[0][0]);
    }
    relume_coder_destroy(&c);
}

// Pixels of rank r about their mean need r components, whatever is asked of them between lights.
static void test_low_rank_is_exact(void **state)
{
    (void)state;
    enum { RANK = 4 };
    uint32_t seed = 5;
    static float kept[sizeof data / sizeof *data];
    double v[RANK + 1][DIM];
    memcpy(kept, data, sizeof data);
    for (int r = 0; r <= RANK; r++)
        for (int j = 0; j < DIM; j++)
            v[r][j] = test_uniform(&seed);
    for (size_t x = 0; x < PIXELS; x++) {
        double a[RANK];
        for (int r = 0; r < RANK; r++)
            a[r] = test_uniform(&seed) - 0.5;
        for (size_t j = 0; j < DIM; j++) {
            double sum = v[RANK][j];
            for (int r = 0; r < RANK; r++)
                sum += a[r] * v[r][j];
            data[((j % LIGHTS) * PIXELS + x) * 3 + j / LIGHTS] = (float)sum;
        }
    }
    relume_coder *exact = create(RANK, "delaunay"), *less = create(RANK - 1, "delaunay");
    CHECK_NEAR(sqrt(residual(exact) / DIM), 0.0, 1e-6);
    assert_true(sqrt(residual(less) / DIM) > 1e-3);
    relume_coder_destroy(&exact);
    relume_coder_destroy(&less);
    memcpy(data, kept, sizeof data);
}

// Captures that say nothing: all black, all alike, one pixel.
static void test_poor_samples(void **state)
{
    (void)state;
    static float flat[LIGHTS * 4 * 3];
    for (int round = 0; round < 3; round++) {
        const struct relume_samples s = {
            .lights = LIGHTS, .pixels = round == 2 ? 1 : 4, .data = flat};
        for (size_t i = 0; i < sizeof flat / sizeof *flat; i++)
            flat[i] = round == 0 ? 0.0f : round == 1 ? 0.5f : (float)i / 100.0f;
        relume_coder *c;
        CHECK_OK(relume_coder_create(
            &c, &relume_basis_pca, lights, LIGHTS,
            relume_coder_params(.coefficients = 5, .hemispherical = true, .samples = &s)));
        float planes[5], w[15], constant[3];
        CHECK_OK(relume_coder_apply(c, flat, 3 * s.pixels, 1, planes, 1));
        relume_coder_weights(c, lights[3], w, constant);
        for (int channel = 0; channel < 3; channel++) {
            double v = (double)constant[channel];
            for (int k = 0; k < 5; k++)
                v += (double)w[channel * 5 + k] * (double)planes[k];
            CHECK_NEAR(v, (double)flat[3 * s.pixels * 3 + (size_t)channel], 1e-3);
        }
        relume_coder_destroy(&c);
    }
}

static void test_needs_samples(void **state)
{
    (void)state;
    relume_coder *c;
    struct test_log log;
    test_log_init(&log);
    assert_int_equal(relume_coder_create(&c, &relume_basis_pca, lights, LIGHTS,
                                         relume_coder_params(.log = &log.log)),
                     RELUME_EINVAL);
    assert_null(c);
    assert_non_null(strstr(log.text, "samples"));
    assert_int_equal(relume_coder_create(&c, &relume_basis_pca, lights, LIGHTS,
                                         relume_coder_params(.coefficients = 9, .decode = true)),
                     RELUME_EUNFIT);
    assert_null(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_residual_is_near_the_least),
        cmocka_unit_test(test_stationary_in_one_metric_for_all_colours),
        cmocka_unit_test(test_all_components_are_the_identity),
        cmocka_unit_test(test_coefficients_come_back),
        cmocka_unit_test(test_coefficients_are_uncorrelated),
        cmocka_unit_test(test_low_rank_is_exact),
        cmocka_unit_test(test_poor_samples),
        cmocka_unit_test(test_needs_samples),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
