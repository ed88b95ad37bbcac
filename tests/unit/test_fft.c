// test_fft.c - tests of src/core/math/fft.h: Fourier and cosine transforms; the folder's door to
// FFTW
// (`make FFT=kiss`: to kissfft)
#include "core/math/fft2d.h"
#include "test.h"

#include <complex.h>

static const double tiny = 2e-5;  // float sums of at most 64 terms of size 1

static void check_lines(void **state)
{
    static const int sizes[] = {2, 8, 30, 64, 98};
    uint32_t random = 1;
    (void)state;
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        const int n = sizes[s];
        float in[256], kept[256], out[256], back[256], scratch[512];
        fft_line *forward, *inverse, *real, *real_inverse;
        CHECK_OK(fft_line_create(&forward, n, FFT_FORWARD));
        CHECK_OK(fft_line_create(&inverse, n, FFT_INVERSE));
        CHECK_OK(fft_line_create(&real, n, FFT_REAL));
        CHECK_OK(fft_line_create(&real_inverse, n, FFT_REAL_INVERSE));
        for (int i = 0; i < 2 * n; i++)
            in[i] = kept[i] = (float)test_uniform(&random) - 0.5f;
        fft_line_run(forward, in, out, scratch);
        for (int k = 0; k < n; k++) {
            double complex want = 0.0;
            for (int i = 0; i < n; i++)
                want += ((double)kept[2 * i] + I * (double)kept[2 * i + 1]) *
                        cexp(-2.0 * M_PI * I * i * k / n);
            CHECK_NEAR((double)out[2 * k], creal(want), tiny);
            CHECK_NEAR((double)out[2 * k + 1], cimag(want), tiny);
        }
        fft_line_run(inverse, out, back, scratch);
        for (int i = 0; i < 2 * n; i++)
            CHECK_NEAR((double)back[i] / n, (double)kept[i], tiny);
        for (int i = 0; i < n; i++)
            in[i] = kept[i];
        fft_line_run(real, in, out, scratch);
        for (int k = 0; k <= n / 2; k++) {
            double complex want = 0.0;
            for (int i = 0; i < n; i++)
                want += (double)kept[i] * cexp(-2.0 * M_PI * I * i * k / n);
            CHECK_NEAR((double)out[2 * k], creal(want), tiny);
            CHECK_NEAR((double)out[2 * k + 1], cimag(want), tiny);
        }
        fft_line_run(real_inverse, out, back, scratch);
        for (int i = 0; i < n; i++)
            CHECK_NEAR((double)back[i] / n, (double)kept[i], tiny);
        fft_line_destroy(&forward);
        fft_line_destroy(&inverse);
        fft_line_destroy(&real);
        fft_line_destroy(&real_inverse);
    }
}

// ---------------------------------------------------------------- planes

enum { W = 20, H = 12, FROM = 3, TO = 9 };

struct picture {
    float in[H][2 * W], out[H][2 * W];
    int floats;  // of a row
};

static void fill(void *context, int row, float *line)
{
    const struct picture *p = context;
    memcpy(line, p->in[row], (size_t)p->floats * sizeof *line);
}

static void take(void *context, int row, const float *line)
{
    struct picture *p = context;
    memcpy(p->out[row], line, (size_t)p->floats * sizeof *line);
}

static void make(struct picture *p, bool real)
{
    uint32_t random = 7;
    *p = (struct picture){.floats = real ? W : 2 * W};
    for (int y = FROM; y < TO; y++)
        for (int i = 0; i < p->floats; i++)
            p->in[y][i] = (float)test_uniform(&random);
}

// Rows beside [FROM, TO) are never written to the spectrum: it starts as noise.
static void transform(const fft2d *f, float *spectrum, struct picture *p)
{
    for (size_t i = 0; i < fft2d_size(f); i++)
        spectrum[i] = 1e6f;
    fft2d_rows(f, spectrum, FROM, TO, fill, p);
    const struct fft2d_step step = {.from = FROM, .to = TO, .end = fft2d_columns(f)};
    fft2d_step_columns(f, spectrum, &step);
}

static void check_planes(void **state)
{
    (void)state;
    for (int real = 0; real < 2; real++) {
        struct picture p;
        fft2d *f;
        make(&p, real);
        CHECK_OK(fft2d_create(&f, W, H, real, 2));
        assert_int_equal(fft2d_columns(f), real ? W / 2 + 1 : W);
        float *const spectrum = malloc(fft2d_size(f) * sizeof *spectrum);
        transform(f, spectrum, &p);
        for (int v = 0; v < H; v++)
            for (int u = 0; u < fft2d_columns(f); u++) {
                double complex want = 0.0;
                for (int y = 0; y < H; y++)
                    for (int x = 0; x < W; x++) {
                        const double complex z =
                            real ? (double)p.in[y][x]
                                 : (double)p.in[y][2 * x] + I * (double)p.in[y][2 * x + 1];
                        want += z * cexp(-2.0 * M_PI * I * ((double)u * x / W + (double)v * y / H));
                    }
                const float *const got = spectrum + (size_t)v * (fft2d_size(f) / H) + 2 * u;
                CHECK_NEAR((double)got[0], creal(want), 2e-4);  // sums of 240 terms of size 1
                CHECK_NEAR((double)got[1], cimag(want), 2e-4);
            }
        fft2d_columns_back(f, spectrum);
        fft2d_rows_back(f, spectrum, 0, H, take, &p);
        for (int y = 0; y < H; y++)
            for (int i = 0; i < p.floats; i++)
                CHECK_NEAR((double)p.out[y][i] / (W * H), (double)p.in[y][i], tiny);
        free(spectrum);
        fft2d_destroy(&f);
    }
}

// A column step that goes there and back is the identity, and a visit that answers false leaves the
// spectrum alone.
static bool keep(void *context, int column, int count, float *lines)
{
    (void)column, (void)count, (void)lines;
    return *(const bool *)context;
}

static void check_passes(void **state)
{
    struct picture p;
    fft2d *f;
    (void)state;
    make(&p, true);
    CHECK_OK(fft2d_create(&f, W, H, true, 3));
    float *const spectrum = malloc(fft2d_size(f) * sizeof *spectrum);
    for (int stored = 0; stored < 2; stored++) {
        bool answer = stored;
        memset(spectrum, 0, fft2d_size(f) * sizeof *spectrum);
        fft2d_rows(f, spectrum, FROM, TO, fill, &p);
        const struct fft2d_step step = {.from = FROM,
                                        .to = TO,
                                        .end = fft2d_columns(f),
                                        .visit = keep,
                                        .context = &answer,
                                        .back = true};
        fft2d_step_columns(f, spectrum, &step);
        fft2d_rows_back(f, spectrum, 0, H, take, &p);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++)
                CHECK_NEAR((double)p.out[y][x] / (stored ? W * H : W), (double)p.in[y][x], tiny);
    }
    free(spectrum);
    fft2d_destroy(&f);
}

static void check_threads(void **state)
{
    struct picture p;
    float *spectrum[2];
    (void)state;
    make(&p, true);
    for (int i = 0; i < 2; i++) {
        fft2d *f;
        CHECK_OK(fft2d_create(&f, W, H, true, i ? 7 : 1));
        spectrum[i] = malloc(fft2d_size(f) * sizeof **spectrum);
        transform(f, spectrum[i], &p);
        if (i)
            for (int y = 0; y < H; y++)
                assert_memory_equal(spectrum[0] + (size_t)y * (fft2d_size(f) / H),
                                    spectrum[1] + (size_t)y * (fft2d_size(f) / H),
                                    2 * (size_t)fft2d_columns(f) * sizeof(float));
        fft2d_destroy(&f);
    }
    free(spectrum[0]);
    free(spectrum[1]);
}

// Lines of odd lengths begin where SIMD does not expect them: a photograph of 487 x 439 crashed.
enum { ODD_W = 487, ODD_H = 439 };

static float odd_at(int row, int i)
{
    return (float)((row * 31 + i * 17) % 101);
}

static void fill_odd(void *context, int row, float *line)
{
    (void)context;
    for (int i = 0; i < 2 * ODD_W; i++)
        line[i] = odd_at(row, i);
}

static void take_odd(void *context, int row, const float *line)
{
    (void)context;
    for (int i = 0; i < 2 * ODD_W; i++)
        CHECK_NEAR(line[i] / (ODD_W * ODD_H), odd_at(row, i), 0.01);
}

static void check_odd_planes(void **state)
{
    (void)state;
    fft2d *f;
    CHECK_OK(fft2d_create(&f, ODD_W, ODD_H, false, 1));
    float *const spectrum = malloc(fft2d_size(f) * sizeof *spectrum);
    assert_non_null(spectrum);
    fft2d_rows(f, spectrum, 0, ODD_H, fill_odd, NULL);
    const struct fft2d_step step = {.to = ODD_H, .end = fft2d_columns(f)};
    fft2d_step_columns(f, spectrum, &step);
    fft2d_columns_back(f, spectrum);
    fft2d_rows_back(f, spectrum, 0, ODD_H, take_odd, NULL);
    free(spectrum);
    fft2d_destroy(&f);
}

static void check_sizes(void **state)
{
    static const int pairs[][2] = {{1, 2}, {2, 2}, {7, 8}, {14, 16}, {97, 100}, {1550, 1600}};
    (void)state;
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        assert_int_equal(fft_good_size(pairs[i][0]), pairs[i][1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(check_lines),  cmocka_unit_test(check_planes),
        cmocka_unit_test(check_passes), cmocka_unit_test(check_threads),
        cmocka_unit_test(check_sizes),  cmocka_unit_test(check_odd_planes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
