// test_bases.c - what must hold for every basis in the registry, without knowing which it is
#include "test.h"

#include "capture_fixture.h"
#include "coder/basis.h"

enum { LIGHTS = 60 };

static struct relume_vec3 lights[LIGHTS];

static int setup(void **state)
{
    (void)state;
    return relume_lights_make(lights, LIGHTS, relume_pattern_find("hammersley"), NULL) != RELUME_OK;
}

#define FOR_EACH_BASIS(b) for (const struct relume_basis *const *b = relume_bases; *b; b++)

// The counts that a basis offers up to the number of lights.
static int counts_of(const struct relume_basis *b, int *counts)
{
    int n = 0;
    for (int k = 1; k <= LIGHTS; k++)
        if (b->has_count(k) && b->fit_count(k, LIGHTS) == k)
            counts[n++] = k;
    return n;
}

static relume_coder *create(const struct relume_basis *b, int k, bool hemispherical, double ridge)
{
    relume_coder *c;
    CHECK_OK(relume_coder_create(
        &c, b, lights, LIGHTS,
        relume_coder_params(.coefficients = k, .ridge = ridge, .hemispherical = hemispherical)));
    assert_int_equal(relume_coder_info(c)->coefficients, k);
    return c;
}

// Stored functions at a direction, first channel.
static void functions(const relume_coder *c, struct relume_vec3 d, float *values)
{
    float weights[3 * 4096], constant[3];
    relume_coder_weights(c, d, weights, constant);
    memcpy(values, weights, (size_t)relume_coder_info(c)->coefficients * sizeof *values);
}

static void encode(const relume_coder *c, const double *samples, double *coefficients)
{
    for (int k = 0; k < relume_coder_info(c)->coefficients; k++) {
        coefficients[k] = 0.0;
        for (int i = 0; i < LIGHTS; i++)
            coefficients[k] += (double)c->map[k * LIGHTS + i] * samples[i];
    }
}

static void decode(const relume_coder *c, const double *coefficients, double *samples)
{
    float values[4096];
    for (int i = 0; i < LIGHTS; i++) {
        functions(c, lights[i], values);
        samples[i] = 0.0;
        for (int k = 0; k < relume_coder_info(c)->coefficients; k++)
            samples[i] += (double)values[k] * coefficients[k];
    }
}

static double rms(const double *a, const double *b)
{
    double sum = 0.0;
    for (int i = 0; i < LIGHTS; i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(sum / LIGHTS);
}

static void reflectance(uint32_t *seed, double *samples)
{
    const struct relume_vec3 n = test_direction(seed), m = test_direction(seed);
    for (int i = 0; i < LIGHTS; i++) {
        const struct relume_vec3 l = lights[i];
        samples[i] = fmax(n.x * l.x + n.y * l.y + n.z * l.z, 0.0) +
                     pow(fmax(m.x * l.x + m.y * l.y + m.z * l.z, 0.0), 30.0) +
                     0.05 * test_uniform(seed);
    }
}

// Single precision maps: 60 terms of 2^-24 each, times the condition of the light set, below 30 for
// counts up to half the lights; the ridge of 1e-12 is far below that.
static const double EXACT = 2e-4, RIDGE = 1e-12;

static void test_exact_on_own_span(void **state)
{
    (void)state;
    uint32_t seed = 1;
    FOR_EACH_BASIS(b)
    {
        int counts[LIGHTS];
        const int n = counts_of(*b, counts);
        assert_true(n >= 1);
        for (int i = 0; i < n; i++) {
            if (counts[i] > LIGHTS / 2 && (*b)->fit_count(0, LIGHTS) != counts[i])
                continue;
            relume_coder *c = create(*b, counts[i], false, RIDGE);
            double in[4096], samples[LIGHTS], out[4096];
            for (int k = 0; k < counts[i]; k++)
                in[k] = 2.0 * test_uniform(&seed) - 1.0;
            decode(c, in, samples);
            encode(c, samples, out);
            for (int k = 0; k < counts[i]; k++)
                CHECK_NEAR(out[k], in[k], EXACT);
            relume_coder_destroy(&c);
        }
    }
}

static void test_projection_is_idempotent(void **state)
{
    (void)state;
    uint32_t seed = 2;
    FOR_EACH_BASIS(b)
    {
        const int k = (*b)->fit_count(0, LIGHTS);
        relume_coder *c = create(*b, k, false, RIDGE);
        double samples[LIGHTS], coefficients[4096], once[LIGHTS], twice[LIGHTS];
        reflectance(&seed, samples);
        encode(c, samples, coefficients);
        decode(c, coefficients, once);
        encode(c, once, coefficients);
        decode(c, coefficients, twice);
        CHECK_NEAR(rms(once, twice), 0.0, EXACT);
        relume_coder_destroy(&c);
    }
}

static void test_longer_never_fits_worse(void **state)
{
    (void)state;
    uint32_t seed = 3;
    double samples[LIGHTS], coefficients[4096], out[LIGHTS];
    for (int round = 0; round < 5; round++) {
        reflectance(&seed, samples);
        FOR_EACH_BASIS(b)
        {
            int counts[LIGHTS];
            const int n = counts_of(*b, counts);
            double before = 1e30;
            for (int i = 0; i < n; i++) {
                relume_coder *c = create(*b, counts[i], false, RIDGE);
                encode(c, samples, coefficients);
                decode(c, coefficients, out);
                const double error = rms(samples, out);
                assert_true(error <= before + EXACT);
                before = error;
                relume_coder_destroy(&c);
            }
        }
    }
}

// The weights of two lights are added before decoding; that must be the sum of both pictures.
static void test_decode_is_linear_in_the_light(void **state)
{
    (void)state;
    char folder[64], path[96];
    test_folder(folder);
    snprintf(path, sizeof path, "%s/pack.exr", folder);
    fixture_write(&(struct fixture){.width = 7, .height = 5, .lights = 30, .views = 1}, folder);
    FOR_EACH_BASIS(b)
    {
        relume_pack *pack;
        const struct relume_codes *codes;
        CHECK_OK(fixture_encode(folder, path, *b, 0, NULL));
        CHECK_OK(relume_pack_open(&pack, path, NULL));
        CHECK_OK(relume_pack_codes(&codes, pack, 0));
        const struct relume_light l[3] = {
            {.direction = {0.3, 0.1, 0.9}, .rgb = {1.0f, 2.0f, 0.5f}},
            {.direction = {-0.7, 0.2, 0.1}, .rgb = {0.3f, 0.3f, 4.0f}},
            {.direction = {0.3, 0.1, 0.9}, .rgb = {3.0f, 6.0f, 1.5f}},
        };
        struct relume_image a = {0}, c = {0}, sum = {0}, three = {0};
        CHECK_OK(relume_relight(&a, codes, &l[0], 1, NULL));
        CHECK_OK(relume_relight(&c, codes, &l[1], 1, NULL));
        CHECK_OK(relume_relight(&sum, codes, l, 2, NULL));
        CHECK_OK(relume_relight(&three, codes, &l[2], 1, NULL));
        for (int i = 0; i < 7 * 5 * 3; i++) {  // single precision sums of some tens of terms
            CHECK_NEAR(sum.data[i], (double)a.data[i] + (double)c.data[i], 1e-5);
            CHECK_NEAR(three.data[i], 3.0 * (double)a.data[i], 1e-5);
        }
        relume_image_destroy(&a);
        relume_image_destroy(&c);
        relume_image_destroy(&sum);
        relume_image_destroy(&three);
        relume_pack_destroy(&pack);
    }
    test_folder_remove(folder);
}

// Storing in 8 bits costs less than 0.1 dB where the light set is good; the fixture's kink leaves a
// residual, against which the cost is measured.
static void test_eight_bits_are_enough(void **state)
{
    (void)state;
    char folder[64], path[96];
    test_folder(folder);
    snprintf(path, sizeof path, "%s/pack.exr", folder);
    for (int hemisphere = 0; hemisphere < 2; hemisphere++) {
        fixture_write(
            &(struct fixture){
                .width = 40, .height = 33, .lights = 60, .views = 1, .hemisphere = hemisphere},
            folder);
        FOR_EACH_BASIS(b)
        {
            if ((*b)->fit_count(9, 60) > 9)
                continue;  // the table has no residual of its own
            relume_capture *capture;
            relume_coder *coder;
            struct relume_encode_report r;
            CHECK_OK(relume_capture_open(&capture, folder, NULL));
            const struct relume_manifest *m = relume_capture_manifest(capture);
            CHECK_OK(relume_coder_create(
                &coder, *b, m->directions, m->lights,
                relume_coder_params(.coefficients = 9, .hemispherical = hemisphere)));
            struct test_log log;
            test_log_init(&log);
            if (relume_pack_encode(capture, coder, path, &r,
                                   relume_pack_encode_params(.log = &log.log)))
                fail_msg("%s", log.text);
            const double cost_db =
                10.0 * log10(1.0 + r.store_rms * r.store_rms / r.fit_rms / r.fit_rms);
            assert_true(r.fit_rms > 1e-3 && r.store_rms > 1e-6);  // both are really measured
            assert_true(cost_db < 0.1);
            relume_coder_destroy(&coder);
            relume_capture_destroy(&capture);
        }
    }
    test_folder_remove(folder);
}

static struct relume_vec3 rotate(const double m[3][3], struct relume_vec3 v)
{
    return (struct relume_vec3){m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
                                m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
                                m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

// A reflectance in the span of 16 harmonics, seen under lights turned together with it, has the
// same energy: the sum of its values over many directions.
static void test_sh_energy_under_rotation(void **state)
{
    (void)state;
    const double c = cos(0.7), s = sin(0.7), p = cos(1.9), q = sin(1.9);
    const double m[3][3] = {{c * p, -s, c * q}, {s * p, c, s * q}, {-q, 0, p}};
    uint32_t seed = 9;
    double coefficients[16], energy[2] = {0, 0};
    relume_coder *coder = create(&relume_basis_sh, 16, false, RIDGE);
    for (int k = 0; k < 16; k++)
        coefficients[k] = test_uniform(&seed) - 0.5;
    struct relume_vec3 many[4000];
    CHECK_OK(relume_lights_make(many, 4000, relume_pattern_find("spiral"), NULL));
    for (int i = 0; i < 4000; i++)
        for (int turned = 0; turned < 2; turned++) {
            float values[16];
            double v = 0.0;
            functions(coder, turned ? rotate(m, many[i]) : many[i], values);
            for (int k = 0; k < 16; k++)
                v += (double)values[k] * coefficients[k];
            energy[turned] += v * v / 4000;
        }
    // a spiral of 4000 points integrates degree 6 to about 1e-4
    CHECK_NEAR(energy[1] / energy[0], 1.0, 1e-3);
    relume_coder_destroy(&coder);
}

static void test_below_the_horizon(void **state)
{
    (void)state;
    FOR_EACH_BASIS(b)
    {
        relume_coder *c = create(*b, (*b)->fit_count(16, LIGHTS), true, 0.0);
        const int k = relume_coder_info(c)->coefficients;
        float low[4096], edge[4096];
        functions(c, (struct relume_vec3){0.6, 0.0, -0.8}, low);
        functions(c, (struct relume_vec3){1.0, 0.0, 0.0}, edge);
        for (int i = 0; i < k; i++)
            CHECK_NEAR(low[i], edge[i], 1e-6);
        relume_coder_destroy(&c);
    }
}

// Regression: a file could state fewer coefficients than lights for the table, with a transform of
// that size, which was read beyond its end.
static void test_count_must_fit(void **state)
{
    (void)state;
    relume_coder *c = NULL;
    const float transform[4] = {1, 0, 0, 1};
    assert_int_equal(relume_coder_create(&c, &relume_basis_table, lights, LIGHTS,
                                         relume_coder_params(.coefficients = 2, .decode = true,
                                                             .transform = transform)),
                     RELUME_EDATA);
    assert_null(c);
    struct test_log log;
    test_log_init(&log);
    assert_int_equal(relume_coder_create(&c, &relume_basis_sh, lights, 8,
                                         relume_coder_params(.log = &log.log, .coefficients = 9)),
                     RELUME_EDATA);
    assert_non_null(strstr(log.text, "at least 9 lights; found 8"));
    assert_int_equal(relume_coder_create(&c, &relume_basis_sh, lights, LIGHTS,
                                         relume_coder_params(.log = &log.log, .coefficients = 10)),
                     RELUME_EINVAL);
    assert_non_null(strstr(log.text, "nearest: 9"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exact_on_own_span),
        cmocka_unit_test(test_projection_is_idempotent),
        cmocka_unit_test(test_longer_never_fits_worse),
        cmocka_unit_test(test_decode_is_linear_in_the_light),
        cmocka_unit_test(test_eight_bits_are_enough),
        cmocka_unit_test(test_sh_energy_under_rotation),
        cmocka_unit_test(test_below_the_horizon),
        cmocka_unit_test(test_count_must_fit),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
