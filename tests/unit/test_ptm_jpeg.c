// The JPEG forms of .ptm as they are written: what the writer says readers see is what the reader
// sees, however planes predict each other; records bound the error of every pixel.
#include "in_folder.h"

#include "exchange/formats/ptm.h"
#include "exchange/formats/sheet.h"

enum { W = 37, H = 21, PIXELS = W * H };

static float wave(int p, int x, int y)
{
    return 127.5f + 90.0f * sinf(0.11f * (float)(x + 3 * p)) * cosf(0.17f * (float)y + (float)p);
}

// Channels: R, G and B of a term follow each other, B inverted. Luminance: every plane its own.
static struct foreign picture(bool luminance)
{
    struct foreign f = {.form = luminance ? FOREIGN_LUMINANCE : FOREIGN_CHANNELS,
                        .functions = {.kind = FUNCTIONS_PTM, .count = 6},
                        .terms = 6};
    CHECK_OK(foreign_create(&f, "made", W, H, luminance ? 9 : 18, NULL, NULL));
    for (int p = 0; p < f.planes; p++) {
        f.scale[p] = luminance && p >= 6 ? 1.0f / 255.0f : 0.01f;
        f.offset[p] = luminance && p >= 6 ? 0.0f : -0.9f;
        for (int i = 0; i < PIXELS; i++) {
            const float v = wave(luminance ? p : p / 3, i % W, i / W);
            f.codes[p * PIXELS + i] = (uint8_t)(luminance    ? v
                                                : p % 3 == 2 ? 255.0f - v
                                                             : v + 5.0f * (float)(p % 3));
        }
    }
    return f;
}

// The picture as a file and as the reader sees it.
struct round {
    struct ptm_jpeg file;
    struct foreign back;
};

static struct round go(const struct foreign *f, double step, int threads)
{
    struct round r;
    char path[128];
    CHECK_OK(ptm_encode_jpeg(&r.file, f, step, 80, threads));
    snprintf(path, sizeof path, "%s/a.ptm", folder);
    test_write(path, r.file.bytes, r.file.size);
    CHECK_OK(ptm_read(&r.back, path, NULL, NULL));
    return r;
}

static void free_round(struct round *r)
{
    ptm_jpeg_free(&r->file);
    foreign_free(&r->back);
}

static void readers_see_what_the_writer_says(void **state)
{
    (void)state;
    static const double steps[] = {0.002, 0.02, 0.1, 2.0};
    for (int luminance = 0; luminance < 2; luminance++)
        for (size_t s = 0; s < sizeof steps / sizeof *steps; s++) {
            struct foreign f = picture(luminance);
            struct round r = go(&f, steps[s], 2);
            assert_int_equal(r.back.form, f.form);
            assert_int_equal(r.back.planes, f.planes);
            assert_memory_equal(r.back.codes, r.file.codes, (size_t)f.planes * PIXELS);
            for (int p = 0; p < f.planes; p++) {
                CHECK_NEAR(r.back.scale[p], f.scale[p], 1e-9);
                CHECK_NEAR(r.back.offset[p], f.offset[p], 1e-7);
            }
            free_round(&r);
            foreign_free(&f);
        }
}

// Scale 0. A bias from 0 / 0 was no number that readers take (found by fuzz_exchange).
static void terms_that_say_nothing(void **state)
{
    (void)state;
    for (int luminance = 0; luminance < 2; luminance++) {
        struct foreign f = picture(luminance);
        const int copies = luminance ? 1 : 3;
        for (int c = 0; c < copies; c++)
            f.scale[2 * copies + c] = f.offset[2 * copies + c] = 0.0f;
        struct round r = go(&f, 0.02, 1);
        assert_memory_equal(r.back.codes, r.file.codes, (size_t)f.planes * PIXELS);
        for (int c = 0; c < copies; c++)
            assert_true(r.back.scale[2 * copies + c] == 0.0f &&
                        r.back.offset[2 * copies + c] == 0.0f);
        free_round(&r);
        foreign_free(&f);
    }
}

static void planes_predict_each_other(void **state)
{
    (void)state;
    struct foreign f = picture(false);
    struct round r = go(&f, 0.02, 1);
    // two of three channels follow the first for every term, B or its two like it by inversion
    assert_true(r.file.predicted >= 12);
    assert_true(r.file.inverted >= 6);
    free_round(&r);
    // a picture of planes that have nothing in common: noise of their own
    uint32_t seed = 5;
    for (size_t i = 0; i < 18 * (size_t)PIXELS; i++)
        f.codes[i] = (uint8_t)(255.0 * test_uniform(&seed));
    r = go(&f, 0.02, 1);
    assert_int_equal(r.file.predicted, 0);
    free_round(&r);
    foreign_free(&f);
}

// A record is written wherever the error is over sqrt(40 bits x the price of a bit).
static void errors_are_bounded(void **state)
{
    (void)state;
    struct foreign f = picture(false);
    uint32_t seed = 9;
    for (int k = 0; k < 40; k++)
        f.codes[(size_t)(17.9 * PIXELS * test_uniform(&seed))] = (uint8_t)(k % 2 ? 255 : 0);
    for (double step = 0.02; step < 0.2; step *= 2.0) {
        struct round r = go(&f, step, 1);
        // xy has the coarsest steps: its square is 1/15 on average, and its scale 0.01
        const double coarsest = fmin(ceil(step / (0.01 * sqrt(1.0 / 15.0))), 255.0);
        const double most = sqrt(40.0 * SHEET_LAMBDA) * coarsest;
        assert_true(r.file.records > 0);
        for (int i = 0; i < 18 * PIXELS; i++)
            assert_true(abs(r.back.codes[i] - f.codes[i]) <= most);
        free_round(&r);
    }
    foreign_free(&f);
}

static void files_do_not_depend_on_threads(void **state)
{
    (void)state;
    struct foreign f = picture(false);
    struct round a = go(&f, 0.03, 1), b = go(&f, 0.03, 5);
    assert_int_equal(a.file.size, b.file.size);
    assert_memory_equal(a.file.bytes, b.file.bytes, a.file.size);
    free_round(&a);
    free_round(&b);
    foreign_free(&f);
}

static void finer_steps_are_nearer(void **state)
{
    (void)state;
    struct foreign f = picture(true);
    double before = 1e9;
    size_t size = 0;
    for (double step = 0.5; step > 0.01; step /= 4.0) {
        struct round r = go(&f, step, 1);
        double square = 0.0;
        for (int i = 0; i < 9 * PIXELS; i++)
            square += pow(r.back.codes[i] - f.codes[i], 2.0);
        assert_true(square < before && r.file.size > size);
        before = square;
        size = r.file.size;
        free_round(&r);
    }
    foreign_free(&f);
}

// Flat planes are their DC, of which a step is an eighth of a code's.
static void flat_pictures_are_written(void **state)
{
    (void)state;
    for (int luminance = 0; luminance < 2; luminance++) {
        struct foreign f = picture(luminance);
        memset(f.codes, 0, (size_t)f.planes * PIXELS);
        struct round r = go(&f, 0.045, 1);
        for (int i = 0; i < f.planes * PIXELS; i++)
            assert_true(r.back.codes[i] <= 255 / 8 + 1);
        assert_int_equal(r.file.records, 0);
        free_round(&r);
        foreign_free(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(readers_see_what_the_writer_says),
        cmocka_unit_test(terms_that_say_nothing),
        cmocka_unit_test(planes_predict_each_other),
        cmocka_unit_test(errors_are_bounded),
        cmocka_unit_test(files_do_not_depend_on_threads),
        cmocka_unit_test(finer_steps_are_nearer),
        cmocka_unit_test(flat_pictures_are_written),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
