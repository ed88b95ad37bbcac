// test_glare.c - tests of include/relume/relight/glare.h: the frame as a living eye would see it:
// convolved with the eye's pattern (psf.h)
#include "core/base/memory.h"
#include "relight/eye/glare.h"
#include "relight/eye/veil.h"
#include "test.h"

// One pattern for all: small, of a default eye.
static relume_psf *psf;
static const struct relume_glare_params plain = {.threads = 2, .fov_deg = 20.0, .no_veil = true};

static int open_psf(void **state)
{
    relume_eye *eye;
    (void)state;
    CHECK_OK(relume_eye_create(&eye, NULL, 10.0));
    CHECK_OK(relume_psf_create(&psf, relume_psf_params(.size = 128, .threads = 2)));
    CHECK_OK(relume_psf_update(psf, eye));
    relume_eye_destroy(&eye);
    return 0;
}

static int close_psf(void **state)
{
    (void)state;
    relume_psf_destroy(&psf);
    return 0;
}

static struct relume_image noise(int width, int height, uint32_t seed)
{
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, width, height, 3));
    for (size_t i = 0; i < 3 * (size_t)width * (size_t)height; i++)
        image.data[i] = (float)test_uniform(&seed);
    return image;
}

static struct relume_image seen(const struct relume_image *frame, struct relume_glare_params p)
{
    struct relume_image out;
    relume_glare *glare;
    CHECK_OK(relume_glare_create(&glare));
    CHECK_OK(relume_glare_apply(&out, glare, frame, false, psf, &p));
    relume_glare_destroy(&glare);
    return out;
}

static double sum_of(const struct relume_image *image, int c)
{
    double sum = 0.0;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        sum += (double)image->data[3 * i + (size_t)c];
    return sum;
}

// ---------------------------------------------------------------- observer

// The standard observer's light between two angles.
static double observed(double from, double to)
{
    double light = 0.0;
    for (double t = from; t < to; t *= 1.001)
        light += relume_cie_glare(t, 35.0, 0.5) * 2.0 * M_PI * sin(t * M_PI / 180.0) * 0.001 * t *
                 M_PI / 180.0;
    return light;
}

// ... that fades out smoothly between them, in 64 steps.
static double faded(double from, double to)
{
    double light = 0.0;
    for (int i = 0; i < 64; i++) {
        const double t = (i + 0.5) / 64.0, a = from + (to - from) * i / 64.0;
        light += (1.0 - t * t * (3.0 - 2.0 * t)) * observed(a, a + (to - from) / 64.0);
    }
    return light;
}

// Against the CIE's general disability glare equation (CIE 146:2002), which holds from 0.1 degrees
// on: 10 / t^3 + (5 / t^2 + 0.1 p / t)(1 + (A / 62.5)^4) + 0.0025 p, per steradian of illuminance;
// and all of the light is somewhere.
static void check_observer(void **state)
{
    (void)state;
    for (double t = 0.3; t < 30.0; t *= 1.5)
        for (double age = 25.0; age < 80.0; age += 25.0) {
            const double general = 10.0 / pow(t, 3.0) +
                                   (5.0 / (t * t) + 0.1 * 0.5 / t) * (1.0 + pow(age / 62.5, 4.0)) +
                                   0.0025 * 0.5;
            // Two fits of the same data.
            CHECK_NEAR(log(relume_cie_glare(t, age, 0.5) / general), 0.0, 0.35);
        }
    CHECK_NEAR(observed(1e-5, 100.0), 1.0, 0.06);
}

// ---------------------------------------------------------------- kernel

static void check_kernel(void **state)
{
    (void)state;
    for (int veil = 0; veil < 2; veil++)
        for (double magnify = 0.5; magnify < 20.0; magnify *= 5.0) {
            struct relume_image kernel;
            struct relume_glare_params p = plain;
            p.no_veil = !veil;
            p.magnify = magnify;
            CHECK_OK(relume_glare_kernel(&kernel, psf, relume_glare_pixel(40.0, 160), &p));
            assert_int_equal(kernel.width % 2, 1);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR(sum_of(&kernel, c), 1.0, 1e-5);
            // Its spread is that of the pattern at the frame's scale, and half of a pixel's tent.
            const int half = kernel.width / 2;
            const double edge =
                relume_psf_shape(psf)->radius * magnify / relume_glare_pixel(40.0, 160);
            double beyond = 0.0;
            for (int y = -half; y <= half; y++)
                for (int x = -half; x <= half; x++)
                    if (hypot(x, y) > edge + 2.0)
                        beyond += (double)kernel.data[3 * ((y + half) * kernel.width + x + half)];
            const double pixel = relume_glare_pixel(40.0, 160) / magnify * 180.0 / M_PI;
            const double want = veil ? observed((edge + 2.0) * pixel, 7.5) + faded(7.5, 12.5) : 0.0;
            // The ring is cut from whole pixels, and some of the veil lies within the pattern.
            CHECK_NEAR(beyond, want, 0.06 * want + 1e-9);
            relume_image_destroy(&kernel);
        }
    struct relume_image kernel;
    assert_int_equal(relume_glare_kernel(&kernel, psf, 1e-7, &plain), RELUME_EINVAL);
}

// ---------------------------------------------------------------- convolution

static void check_delta(void **state)
{
    struct relume_image frame, kernel, out;
    (void)state;
    CHECK_OK(relume_image_create(&frame, 41, 30, 3));
    for (int c = 0; c < 3; c++)
        frame.data[3 * (12 * 41 + 17) + c] = (float)(c + 1);
    CHECK_OK(relume_glare_kernel(&kernel, psf, relume_glare_pixel(20.0, 41), &plain));
    out = seen(&frame, plain);
    const int half = kernel.width / 2;
    for (int y = 0; y < 30; y++)
        for (int x = 0; x < 41; x++)
            for (int c = 0; c < 3; c++) {
                const int kx = x - 17 + half, ky = y - 12 + half;
                const bool in = kx >= 0 && kx < kernel.width && ky >= 0 && ky < kernel.width;
                const double want =
                    in ? (c + 1.0) * (double)kernel.data[3 * (ky * kernel.width + kx) + c] : 0.0;
                CHECK_NEAR((double)out.data[3 * (y * 41 + x) + c], want, 1e-6);
            }
    relume_image_destroy(&frame);
    relume_image_destroy(&kernel);
    relume_image_destroy(&out);
}

static int wrap(int i, int n, enum relume_glare_border border)
{
    if (i >= 0 && i < n)
        return i;
    if (border == RELUME_GLARE_ZERO)
        return -1;
    return border == RELUME_GLARE_CLAMP ? (i < 0 ? 0 : n - 1) : (i % n + n) % n;
}

// Every border against sums over the kernel, one tile and many.
static void check_borders(void **state)
{
    enum { W = 37, H = 22, REACH = 9, SIDE = 2 * REACH + 1 };
    struct relume_image in = noise(W, H, 3);
    float weights[3][SIDE * SIDE], out[3 * W * H];
    struct kernel kernel = {REACH, {weights[0], weights[1], weights[2]}};
    uint32_t random = 9;
    (void)state;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < SIDE * SIDE; i++)
            weights[c][i] = (float)test_uniform(&random) / (SIDE * SIDE);
    for (int border = 0; border < 3; border++)
        for (int many = 0; many < 2; many++) {
            convolver *c;
            CHECK_OK(convolver_create(&c, W, H, REACH, (enum relume_glare_border)border, 2));
            if (many) {
                convolver_destroy(&c);
                CHECK_OK(convolver_create_tiled(&c, W, H, REACH, (enum relume_glare_border)border,
                                                2, 30));
            }
            for (int again = 0; again < 2; again++)
                CHECK_OK(convolver_run(c, out, in.data, again, &kernel));
            for (int y = 0; y < H; y++)
                for (int x = 0; x < W; x++)
                    for (int k = 0; k < 3; k++) {
                        double want = 0.0;
                        for (int v = -REACH; v <= REACH; v++)
                            for (int u = -REACH; u <= REACH; u++) {
                                const int sy = wrap(y - v, H, (enum relume_glare_border)border);
                                const int sx = wrap(x - u, W, (enum relume_glare_border)border);
                                if (sx >= 0 && sy >= 0)
                                    want += (double)in.data[3 * (sy * W + sx) + k] *
                                            (double)weights[k][(v + REACH) * SIDE + u + REACH];
                            }
                        CHECK_NEAR((double)out[3 * (y * W + x) + k], want, 2e-6);
                    }
            convolver_destroy(&c);
        }
    relume_image_destroy(&in);
}

// What must stay: a constant frame beside itself, the mean of a periodic one, the light of a lamp
// that is far enough from the edge.
static void check_light(void **state)
{
    struct relume_image frame = noise(60, 44, 1), out;
    struct relume_glare_params p = plain;
    (void)state;
    p.border = RELUME_GLARE_PERIODIC;
    p.no_veil = false;
    frame.data[3 * 700] = 1e4f;
    out = seen(&frame, p);
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(sum_of(&out, c) / sum_of(&frame, c), 1.0, 1e-4);
    relume_image_destroy(&out);
    for (size_t i = 0; i < 3 * 60 * 44; i++)
        frame.data[i] = 0.7f;
    p.border = RELUME_GLARE_CLAMP;
    out = seen(&frame, p);
    for (size_t i = 0; i < 3 * 60 * 44; i++)
        CHECK_NEAR((double)out.data[i], 0.7, 1e-5);
    relume_image_destroy(&out);
    memset(frame.data, 0, 3 * 60 * 44 * sizeof *frame.data);
    for (size_t c = 0; c < 3; c++)
        frame.data[3 * (22 * 60 + 30) + c] = 100.0f;
    out = seen(&frame, plain);
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(sum_of(&out, c), 100.0, 1e-2);
    relume_image_destroy(&out);
    relume_image_destroy(&frame);
}

static void check_threads(void **state)
{
    struct relume_image frame = noise(50, 31, 4), one, many;
    struct relume_glare_params p = plain;
    (void)state;
    frame.data[500] = 300.0f;
    for (int mode = 0; mode < 3; mode++) {
        p.mode = (enum relume_glare_mode)mode;
        p.threads = 1;
        one = seen(&frame, p);
        p.threads = 5;
        many = seen(&frame, p);
        assert_memory_equal(one.data, many.data, 3 * 50 * 31 * sizeof *one.data);
        relume_image_destroy(&one);
        relume_image_destroy(&many);
    }
    relume_image_destroy(&frame);
}

// A frame at rest is transformed once, and seen the same.
static void check_rest(void **state)
{
    struct relume_image frame = noise(50, 31, 4), first, second;
    relume_glare *glare;
    (void)state;
    CHECK_OK(relume_glare_create(&glare));
    CHECK_OK(relume_glare_apply(&first, glare, &frame, false, psf, &plain));
    CHECK_OK(relume_glare_apply(&second, glare, &frame, true, psf, &plain));
    assert_memory_equal(first.data, second.data, 3 * 50 * 31 * sizeof *first.data);
    relume_image_destroy(&second);
    struct relume_image other = noise(20, 31, 4);
    CHECK_OK(relume_glare_apply(&second, glare, &other, true, psf, &plain));
    struct relume_image fresh = seen(&other, plain);
    assert_memory_equal(fresh.data, second.data, 3 * 20 * 31 * sizeof *fresh.data);
    relume_glare_destroy(&glare);
    relume_image_destroy(&first);
    relume_image_destroy(&second);
    relume_image_destroy(&fresh);
    relume_image_destroy(&other);
    relume_image_destroy(&frame);
}

// ---------------------------------------------------------------- sources

static void check_sources(void **state)
{
    enum { W = 16, H = 9 };
    float rest[3 * W * H];
    struct sources s;
    (void)state;
    for (int i = 0; i < 3 * W * H; i++)
        rest[i] = 0.5f;
    CHECK_NEAR(sources_threshold(rest, W * H, 4), 0.5 * 33.0 / 32.0, 1e-6);
    // A bent spot of three, one of one.
    static const int bright[][2] = {{3, 2}, {4, 3}, {5, 3}, {12, 7}};
    for (int k = 0; k < 4; k++)
        for (int c = 0; c < 3; c++)
            rest[3 * (bright[k][1] * W + bright[k][0]) + c] = k == 2 ? 5.0f : 3.0f;
    const double threshold = sources_threshold(rest, W * H, 4);
    assert_true(threshold >= 0.5 && threshold < 0.6);
    CHECK_OK(sources_find(&s, rest, W, H, 1.0, true));
    assert_int_equal(s.count, 2);
    CHECK_NEAR((double)s.source[0].rgb[0], 2.0 + 2.0 + 4.0, 1e-5);
    CHECK_NEAR((double)s.source[0].x, (2.0 * 3.5 + 2.0 * 4.5 + 4.0 * 5.5) / 8.0, 1e-5);
    CHECK_NEAR((double)s.source[0].y, (2.0 * 2.5 + 6.0 * 3.5) / 8.0, 1e-5);
    CHECK_NEAR((double)s.source[1].x, 12.5, 0.0);
    CHECK_NEAR((double)rest[3 * (7 * W + 12)], 1.0, 1e-6);
    sources_destroy(&s);
    CHECK_OK(sources_find(&s, rest, W, H, 2.0, true));
    assert_int_equal(s.count, 0);
    sources_destroy(&s);
}

// One lamp before a black wall: all modes see the same, but for the coarse veil of the hybrid.
static void check_modes(void **state)
{
    struct relume_image frame, fft, other;
    struct relume_glare_params p = plain;
    (void)state;
    CHECK_OK(relume_image_create(&frame, 64, 48, 3));
    for (size_t c = 0; c < 3; c++)
        frame.data[3 * (20 * 64 + 30) + c] = 50.0f;
    fft = seen(&frame, p);
    for (int mode = 1; mode < 3; mode++) {
        p.mode = (enum relume_glare_mode)mode;
        p.threshold = 1e-6;
        other = seen(&frame, p);
        for (size_t i = 0; i < 3 * 64 * 48; i++)
            CHECK_NEAR((double)other.data[i], (double)fft.data[i], 2e-5);
        relume_image_destroy(&other);
    }
    // With the veil, and nothing bright enough to be a source: light far from the lamp is smooth
    // enough for a quarter of the resolution.
    p.mode = RELUME_GLARE_FFT;
    p.no_veil = false;
    p.magnify = 4.0;
    relume_image_destroy(&fft);
    fft = seen(&frame, p);
    p.mode = RELUME_GLARE_HYBRID;
    p.threshold = 1e6;
    other = seen(&frame, p);
    CHECK_NEAR(sum_of(&other, 1) / sum_of(&fft, 1), 1.0, 0.03);
    relume_image_destroy(&other);
    relume_image_destroy(&fft);
    relume_image_destroy(&frame);
}

// ---------------------------------------------------------------- hostile frames

static void check_hostile(void **state)
{
    struct relume_image frame = noise(9, 7, 2), out;
    relume_glare *glare;
    struct test_log log;
    struct relume_glare_params p = plain;
    (void)state;
    test_log_init(&log);
    p.log = &log.log;
    CHECK_OK(relume_glare_create(&glare));
    frame.data[0] = NAN;
    frame.data[1] = INFINITY;
    frame.data[2] = -INFINITY;
    frame.data[3] = -0.25f;
    frame.data[50] = 40.0f;
    for (int mode = 0; mode < 3; mode++) {
        p.mode = (enum relume_glare_mode)mode;
        CHECK_OK(relume_glare_apply(&out, glare, &frame, false, psf, &p));
        for (size_t i = 0; i < 3 * 9 * 7; i++)
            assert_true(isfinite(out.data[i]));
        assert_non_null(strstr(log.text, "3 pixels are not numbers"));
        relume_image_destroy(&out);
    }
    CHECK_NEAR(relume_glare_luminance(&(struct relume_image){1, 1, 3, .data = frame.data}), 0.0,
               0.0);
    struct relume_image dot = {1, 1, 3, .data = (float[]){1, 1, 1}};
    for (int mode = 0; mode < 3; mode++)
        for (int border = 0; border < 3; border++) {
            p.mode = (enum relume_glare_mode)mode;
            p.border = (enum relume_glare_border)border;
            CHECK_OK(relume_glare_apply(&out, glare, &dot, false, psf, &p));
            assert_true(out.data[0] > 0.0f && out.data[0] <= 1.001f);
            relume_image_destroy(&out);
        }
    struct relume_image black = {9, 7, 3, .data = calloc(3 * 9 * 7, sizeof(float))};
    for (int mode = 0; mode < 3; mode++) {
        p.mode = (enum relume_glare_mode)mode;
        CHECK_OK(relume_glare_apply(&out, glare, &black, false, psf, &p));
        for (size_t i = 0; i < 3 * 9 * 7; i++)
            CHECK_NEAR((double)out.data[i], 0.0, 0.0);
        relume_image_destroy(&out);
    }
    free(black.data);
    static const struct relume_glare_params bad[] = {
        {.fov_deg = -1},
        {.fov_deg = 170.1},
        {.fov_deg = NAN},
        {.magnify = -1},
        {.magnify = NAN},
        {.sources = -1},
        {.threshold = -1},
        {.threshold = NAN},
        {.mode = 3},
        {.border = 3},
        {.fov_deg = 0.01, .magnify = 1000},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        p = bad[i];
        p.log = &log.log;
        log.lines = 0;
        assert_int_equal(relume_glare_apply(&out, glare, &dot, false, psf, &p), RELUME_EINVAL);
        assert_int_equal(log.lines, 1);
        assert_null(out.data);
    }
    relume_glare_destroy(&glare);
    relume_image_destroy(&frame);
}

// Whichever allocation fails, the answer is RELUME_ENOMEM and nothing leaks; the next try works.
static relume_status see_once(void)
{
    struct relume_image frame = noise(12, 9, 3), out = {0};
    relume_eye *eye = NULL;
    relume_psf *small = NULL;
    relume_glare *glare = NULL;
    struct relume_glare_params p = {.threads = 1, .mode = RELUME_GLARE_HYBRID};
    struct relume_subject few = relume_subject_default();
    few.cornea.count = 10;
    few.fibres.halo_deg = 0.0;
    relume_status status = relume_eye_create(&eye, &few, 1.0);
    if (!status)
        status = relume_psf_create(
            &small, relume_psf_params(.size = 64, .wavelengths = 2, .threads = 1, .planes = 2));
    if (!status)
        status = relume_psf_update(small, eye);
    if (!status)
        status = relume_glare_create(&glare);
    for (int mode = 0; !status && mode < 3; mode++) {
        p.mode = (enum relume_glare_mode)mode;
        status = relume_glare_apply(&out, glare, &frame, false, small, &p);
        relume_image_destroy(&out);
    }
    relume_glare_destroy(&glare);
    relume_psf_destroy(&small);
    relume_eye_destroy(&eye);
    relume_image_destroy(&frame);
    return status;
}

static void check_memory(void **state)
{
    int failed = 0;
    (void)state;
    for (long n = 3; n < 1000; n++) {  // the frame itself is made first
        mem_fail_after(n);
        const relume_status status = see_once();
        const bool pending = mem_fail_pending();
        mem_fail_after(0);
        if (pending) {
            CHECK_OK(status);
            assert_true(failed > 30);
            return;
        }
        assert_int_equal(status, RELUME_ENOMEM);
        failed++;
    }
    fail_msg("no end of allocations");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(check_observer), cmocka_unit_test(check_kernel),
        cmocka_unit_test(check_delta),    cmocka_unit_test(check_borders),
        cmocka_unit_test(check_light),    cmocka_unit_test(check_threads),
        cmocka_unit_test(check_rest),     cmocka_unit_test(check_sources),
        cmocka_unit_test(check_modes),    cmocka_unit_test(check_memory),
        cmocka_unit_test(check_hostile),
    };
    return cmocka_run_group_tests(tests, open_psf, close_psf);
}
