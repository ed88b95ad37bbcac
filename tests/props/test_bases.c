// test_bases.c - what must hold for every basis in the registry, without knowing which it is
#include "test.h"

#include "capture_fixture.h"
#include "format/coder/basis.h"
#include "format/coder/coding.h"

enum { LIGHTS = 60, MOST_PLANES = 3 * RELUME_MOST_COEFFICIENTS };

static struct relume_vec3 lights[LIGHTS];
static struct relume_vec3 dome[LIGHTS];  // the same above the horizon

static int setup(void **state)
{
    (void)state;
    if (relume_directions_make(lights, LIGHTS, relume_pattern_find("hammersley"), NULL))
        return 1;
    for (int i = 0; i < LIGHTS; i++)
        dome[i] = (struct relume_vec3){lights[i].x, lights[i].y, fabs(lights[i].z)};
    return 0;
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

// What a pixel is under the lights of `c`: samples[light][channel].
static void reflectance(uint32_t *seed, const struct relume_vec3 *l, float (*samples)[3])
{
    const struct relume_vec3 n = test_direction(seed), m = test_direction(seed);
    for (int i = 0; i < LIGHTS; i++)
        for (int c = 0; c < 3; c++)
            samples[i][c] =
                (float)((0.5 + 0.2 * c) * fmax(n.x * l[i].x + n.y * l[i].y + n.z * l[i].z, 0.0) +
                        pow(fmax(m.x * l[i].x + m.y * l[i].y + m.z * l[i].z, 0.0), 30.0) +
                        0.05 * test_uniform(seed));
}

static relume_coder *create(const struct relume_basis *b, int k, bool hemispherical, double ridge)
{
    enum { PIXELS = 400 };
    relume_coder *c;
    const bool above = hemispherical || b->upper_only;
    const struct relume_vec3 *l = above ? dome : lights;
    struct relume_samples s = {.lights = LIGHTS, .pixels = PIXELS};
    s.data = malloc(sizeof(float) * 3 * LIGHTS * PIXELS);
    uint32_t seed = 77;
    for (size_t x = 0; x < PIXELS; x++) {
        float one[LIGHTS][3];
        reflectance(&seed, l, one);
        for (size_t i = 0; i < LIGHTS; i++)
            memcpy(s.data + (i * PIXELS + x) * 3, one[i], sizeof one[i]);
    }
    CHECK_OK(relume_coder_create(&c, b, l, LIGHTS,
                                 relume_coder_params(.coefficients = k, .ridge = ridge,
                                                     .hemispherical = above, .samples = &s)));
    free(s.data);
    assert_int_equal(relume_coder_info(c)->coefficients, k);
    return c;
}

// Stored functions at a direction, first channel.
static void functions(const relume_coder *c, struct relume_vec3 d, float *values)
{
    float weights[MOST_PLANES], constant[3];
    relume_coder_weights(c, d, weights, constant);
    memcpy(values, weights, (size_t)relume_coder_info(c)->coefficients * sizeof *values);
}

static void encode(const relume_coder *c, float (*samples)[3], float *planes)
{
    CHECK_OK(relume_coder_apply(c, &samples[0][0], 3, 1, planes, 1));
}

static void decode(const relume_coder *c, const float *planes, float (*samples)[3])
{
    const struct relume_coder_info *info = relume_coder_info(c);
    float weights[MOST_PLANES], constant[3];
    for (int i = 0; i < LIGHTS; i++) {
        relume_coder_weights(c, info->directions[i], weights, constant);
        for (int channel = 0; channel < 3; channel++) {
            double sum = (double)constant[channel];
            for (int k = 0; k < info->coefficients; k++)
                sum += (double)weights[channel * info->coefficients + k] *
                       (double)planes[relume_coder_plane(info, k, channel)];
            samples[i][channel] = (float)sum;
        }
    }
}

static double rms(float (*a)[3], float (*b)[3])
{
    double sum = 0.0;
    for (int i = 0; i < 3 * LIGHTS; i++) {
        const double d = (double)a[i / 3][i % 3] - (double)b[i / 3][i % 3];
        sum += d * d;
    }
    return sqrt(sum / (3 * LIGHTS));
}

// Single precision maps: 60 terms of 2^-24 each, times the condition of the light set, below 30 for
// counts up to half the lights; the ridge of 1e-12 is far below that.
static const double EXACT = 2e-4, RIDGE = 1e-12;
// On one hemisphere values are assumed at the horizon, with the weight 1e-4, against coefficients
// that differ from them by some units.
static const double FILLED = 2e-3;

// What its own functions make of coefficients comes back as these coefficients. Not where the map
// is no fit (dct-resampled) or the interpolant does not reproduce the captured lights.
static void test_exact_on_own_span(void **state)
{
    (void)state;
    uint32_t seed = 1;
    FOR_EACH_BASIS(b)
    {
        int counts[LIGHTS];
        const int n = counts_of(*b, counts);
        assert_true(n >= 1);
        for (int i = 0; i < n && *b != &relume_basis_dct_resampled;
             i += TEST_SANITIZED && n > 9 ? 5 : 1) {
            if (counts[i] > LIGHTS / 2 && (*b)->fit_count(0, LIGHTS) != counts[i])
                continue;
            relume_coder *c = create(*b, counts[i], false, RIDGE);
            const int planes = relume_coder_info(c)->planes;
            float in[MOST_PLANES], samples[LIGHTS][3], out[MOST_PLANES];
            for (int k = 0; k < planes; k++)
                in[k] = (float)(2.0 * test_uniform(&seed) - 1.0);
            decode(c, in, samples);
            encode(c, samples, out);
            for (int k = 0; k < planes; k++)
                CHECK_NEAR(out[k], in[k], (*b)->upper_only ? FILLED : EXACT);
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
        if (*b == &relume_basis_dct_resampled)
            continue;
        const int k = (*b)->fit_count(0, LIGHTS);
        relume_coder *c = create(*b, k, false, RIDGE);
        float samples[LIGHTS][3], planes[MOST_PLANES], once[LIGHTS][3], twice[LIGHTS][3];
        reflectance(&seed, relume_coder_info(c)->directions, samples);
        encode(c, samples, planes);
        decode(c, planes, once);
        encode(c, once, planes);
        decode(c, planes, twice);
        CHECK_NEAR(rms(once, twice), 0.0, EXACT);
        relume_coder_destroy(&c);
    }
}

// Learned bases look at the lights between the captured ones instead.
static void test_longer_never_fits_worse(void **state)
{
    (void)state;
    uint32_t seed = 3;
    for (int round = 0; round < 5; round++)
        FOR_EACH_BASIS(b)
        {
            if (*b == &relume_basis_dct_resampled || (*b)->learned)
                continue;
            int counts[LIGHTS];
            const int n = counts_of(*b, counts);
            const uint32_t same = seed + (uint32_t)round;
            double before = 1e30;
            for (int i = 0; i < n; i++) {
                relume_coder *c = create(*b, counts[i], false, RIDGE);
                float samples[LIGHTS][3], planes[MOST_PLANES], out[LIGHTS][3];
                uint32_t again = same;
                reflectance(&again, relume_coder_info(c)->directions, samples);
                encode(c, samples, planes);
                decode(c, planes, out);
                const double error = rms(samples, out);
                assert_true(error <= before + EXACT);
                before = error;
                relume_coder_destroy(&c);
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
    FOR_EACH_BASIS(b)
    {
        fixture_write(
            &(struct fixture){
                .width = 7, .height = 5, .lights = 30, .views = 1, .hemisphere = (*b)->upper_only},
            folder);
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
            if ((*b)->fit_count(9, 60) > 9 || ((*b)->upper_only && !hemisphere))
                continue;  // the table has no residual of its own
            relume_capture *capture;
            relume_coder *coder;
            struct relume_fidelity r;
            CHECK_OK(relume_capture_open(&capture, folder, NULL));
            CHECK_OK(relume_coder_learn(&coder, *b, capture,
                                        relume_coder_params(.coefficients = (*b)->fit_count(9, 60)),
                                        NULL));
            struct test_log log;
            test_log_init(&log);
            if (relume_pack_encode(capture, coder, path, &r,
                                   relume_pack_encode_params(.log = &log.log)))
                fail_msg("%s", log.text);
            const double cost_db =
                10.0 * log10(1.0 + r.store_rms * r.store_rms / r.fit_rms / r.fit_rms);
            assert_true(r.fit_rms > 1e-3 && r.store_rms > 1e-6);  // both are really measured
            // principal components leave little of this fixture: there, a code of the eye's scale
            if (!(cost_db < 0.1 || ((*b)->learned && r.store_rms < 0.25 / 255)))
                fail_msg("%s: 8 bits cost %.3f dB (%g, %g)", (*b)->name, cost_db, r.fit_rms,
                         r.store_rms);
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
    CHECK_OK(relume_directions_make(many, 4000, relume_pattern_find("spiral"), NULL));
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
                     RELUME_EUNFIT);
    assert_null(c);
    struct test_log log;
    test_log_init(&log);
    assert_int_equal(relume_coder_create(&c, &relume_basis_sh, lights, 8,
                                         relume_coder_params(.log = &log.log, .coefficients = 9)),
                     RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "at least 9 lights; found 8"));
    assert_int_equal(relume_coder_create(&c, &relume_basis_sh, lights, LIGHTS,
                                         relume_coder_params(.log = &log.log, .coefficients = 10)),
                     RELUME_EINVAL);
    assert_non_null(strstr(log.text, "the nearest number is 9"));
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
