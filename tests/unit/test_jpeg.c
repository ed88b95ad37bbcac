// Planes as JPEG: codes come back unmanaged; broken files are errors that name the file.
#include "test.h"

#include "image/image/jpeg.h"
#include "image/image/trellis.h"

enum { W = 37, H = 21, BLOCKS = 5 * 3 };

// Noise of different size in every plane, so that a colour transform would show.
static void fill(float *plane, int seed, float size)
{
    uint32_t state = (uint32_t)seed;
    for (int i = 0; i < W * H; i++)
        plane[i] = size * (float)(test_uniform(&state) - 0.5) + 20.0f * (float)sin(i * 0.05);
}

struct made {
    uint8_t *bytes;
    size_t size;
    float plane[3][W * H];
};

static void make(struct made *m, int planes, enum jpeg_colour colour, int step, double lambda)
{
    static float dct[BLOCKS * 64];
    static int16_t codes[3][BLOCKS * 64];
    struct jpeg_picture p = {.width = W, .height = H, .planes = planes, .colour = colour};
    for (int c = 0; c < planes; c++) {
        fill(m->plane[c], 5 + c, 30.0f + 40.0f * (float)c);
        trellis_transform(m->plane[c], W, H, dct);
        trellis_quantise(dct, BLOCKS, step, lambda, codes[c]);
        p.step[c] = step;
        p.coefficients[c] = codes[c];
    }
    CHECK_OK(jpeg_encode(&m->bytes, &m->size, &p));
}

static void planes_come_back(void **state)
{
    (void)state;
    for (int planes = 1; planes <= 3; planes += 2) {
        struct made m;
        struct jpeg_codes codes;
        make(&m, planes, JPEG_PLANES, 1, 0.0);
        CHECK_OK(jpeg_decode(&codes, m.bytes, m.size, "made", NULL, NULL));
        assert_int_equal(codes.width, W);
        assert_int_equal(codes.height, H);
        assert_int_equal(codes.planes, planes);
        // 64 rounded coefficients of an orthonormal transform: rms 0.29, then rounding to codes
        for (int c = 0; c < planes; c++)
            for (int i = 0; i < W * H; i++)
                CHECK_NEAR(codes.data[c * W * H + i], 128.0 + (double)m.plane[c][i], 2.0);
        jpeg_codes_free(&codes);
        relume_free(m.bytes);
    }
}

static bool has(const struct made *m, const char *text)
{
    return memmem(m->bytes, m->size, text, strlen(text)) != NULL;
}

static void planes_carry_no_colour(void **state)
{
    (void)state;
    struct made m;
    make(&m, 3, JPEG_PLANES, 8, 0.1);
    const uint8_t *adobe = memmem(m.bytes, m.size, "Adobe", 5);
    assert_non_null(adobe);
    assert_int_equal(adobe[11], 0);  // transform: none
    assert_false(has(&m, "JFIF"));
    assert_false(has(&m, "ICC_PROFILE"));
    relume_free(m.bytes);
    make(&m, 3, JPEG_YCBCR, 8, 0.1);
    assert_true(has(&m, "JFIF"));
    assert_false(has(&m, "Adobe"));
    relume_free(m.bytes);
}

static void broken_files_are_errors(void **state)
{
    (void)state;
    struct made m;
    struct jpeg_codes codes;
    struct test_log log;
    make(&m, 3, JPEG_PLANES, 4, 0.1);
    const size_t cuts[] = {0, 1, 2, 10, m.size / 2, m.size - 40};
    for (size_t i = 0; i < sizeof cuts / sizeof *cuts; i++) {
        test_log_init(&log);
        assert_true(relume_status_is_input(
            jpeg_decode(&codes, m.bytes, cuts[i], "cut.jpg", NULL, &log.log)));
        assert_non_null(strstr(log.text, "cut.jpg: "));
        assert_int_equal(log.lines, 1);
        assert_null(codes.data);
    }
    const struct relume_limits small = {.max_side = W - 1};
    test_log_init(&log);
    assert_int_equal(jpeg_decode(&codes, m.bytes, m.size, "big.jpg", &small, &log.log),
                     RELUME_EDAMAGED);
    assert_non_null(strstr(log.text, "limits"));
    test_log_init(&log);
    assert_int_equal(jpeg_read(&codes, "/nowhere/x.jpg", NULL, &log.log), RELUME_ENOTFOUND);
    assert_non_null(strstr(log.text, "/nowhere/x.jpg: cannot be opened"));
    relume_free(m.bytes);
}

// ---------------------------------------------------------------- quantisation

static void the_transform_keeps_energy(void **state)
{
    (void)state;
    float plane[16 * 16], dct[4 * 64];
    uint32_t seed = 3;
    double before = 0.0, after = 0.0;
    for (int i = 0; i < 256; i++) {
        plane[i] = (float)test_uniform(&seed) - 0.3f;
        before += (double)(plane[i] * plane[i]);
    }
    trellis_transform(plane, 16, 16, dct);
    for (int i = 0; i < 256; i++)
        after += (double)(dct[i] * dct[i]);
    CHECK_NEAR(after, before, 1e-4);
    double mean = 0.0;  // of the second block
    for (int i = 0; i < 64; i++)
        mean += (double)plane[i / 8 * 16 + 8 + i % 8] / 64.0;
    CHECK_NEAR((double)dct[64], 8.0 * mean, 1e-5);
}

// Bits fall and errors grow with lambda, and for its own lambda a choice costs less than rounding.
static void lambda_trades_errors_for_bits(void **state)
{
    (void)state;
    enum { SIDE = 128, N = SIDE * SIDE / 64 };
    static float plane[SIDE * SIDE], dct[N * 64];
    static int16_t codes[N * 64];
    uint32_t seed = 9;
    for (int i = 0; i < SIDE * SIDE; i++)
        plane[i] = 8.0f * ((float)test_uniform(&seed) - 0.5f) + 30.0f * sinf((float)i * 0.02f);
    trellis_transform(plane, SIDE, SIDE, dct);
    const double step = 6.0, lambdas[] = {0.0, 0.05, 0.15, 0.4};
    struct trellis_result before = {0.0, 1e30}, rounded = {0.0, 0.0};
    for (int i = 0; i < 4; i++) {
        const struct trellis_result r = trellis_quantise(dct, N, step, lambdas[i], codes);
        assert_true(r.bits < before.bits);
        assert_true(r.distortion > before.distortion);
        if (i == 0)
            rounded = r;
        const double price = lambdas[i] * step * step;
        assert_true(r.distortion + price * r.bits <= rounded.distortion + price * rounded.bits);
        double distortion = 0.0;
        for (int j = 0; j < N * 64; j++)
            distortion += pow((double)dct[j] - step * codes[j], 2.0);
        CHECK_NEAR(r.distortion, distortion, 1e-6 * distortion);
        before = r;
    }
}

// What the model counts is what libjpeg writes, but for tables and headers.
static void bits_are_those_of_the_file(void **state)
{
    (void)state;
    enum { SIDE = 256, N = SIDE * SIDE / 64 };
    static float plane[SIDE * SIDE], dct[N * 64];
    static int16_t codes[N * 64];
    uint32_t seed = 11;
    for (int i = 0; i < SIDE * SIDE; i++)
        plane[i] = 30.0f * ((float)test_uniform(&seed) - 0.5f);
    trellis_transform(plane, SIDE, SIDE, dct);
    const struct trellis_result r = trellis_quantise(dct, N, 12.0, 0.1, codes);
    const struct jpeg_picture p = {
        .width = SIDE, .height = SIDE, .planes = 1, .step = {12}, .coefficients = {codes}};
    uint8_t *bytes;
    size_t size;
    CHECK_OK(jpeg_encode(&bytes, &size, &p));
    assert_true((double)size < 1.06 * r.bits / 8.0 + 400.0);
    assert_true((double)size > 0.9 * r.bits / 8.0);
    relume_free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_come_back),
        cmocka_unit_test(planes_carry_no_colour),
        cmocka_unit_test(broken_files_are_errors),
        cmocka_unit_test(the_transform_keeps_energy),
        cmocka_unit_test(lambda_trades_errors_for_bits),
        cmocka_unit_test(bits_are_those_of_the_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
