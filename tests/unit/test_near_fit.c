// Near lights: coefficients fitted at each pixel's own directions
#include "lambert_fixture.h"

#include "capture/manifest/reflectance_table.h"
#include "format/coder/coding.h"
#include "format/coder/near_fit.h"

#include <relume/format/coder.h>

enum { PIXELS = BUMP_SIDE * BUMP_SIDE, MOST_PLANES = 48 };

// What a pixel shows of light from direction d: in the span of PTM, not linear in the light.
static double reflectance(int x, int y, int channel, struct relume_vec3 d)
{
    const double a = 0.3 * x / BUMP_SIDE, b = 0.2 * y / BUMP_SIDE;
    return 0.4 + a * d.x * d.x - b * d.y * d.y + 0.2 * d.x * d.y + 0.1 * (channel + 1) * d.x -
           0.15 * d.y;
}

static struct relume_vec3 towards(int light, int x, int y)
{
    const struct relume_vec3 p = bump_point(x, y), d = bump_light(light);
    return vec3_unit((struct relume_vec3){3 * d.x - p.x, 3 * d.y - p.y, 3 * d.z - p.z});
}

static relume_capture *open_quadratic(char folder[64])
{
    const struct bump plane = {
        .near = true, .flat = true, .no_falloff = true, .normal_of_plane = {0, 0, 1}};
    relume_capture *capture;
    struct relume_image image;
    char path[128];
    test_folder(folder);
    bump_write(&plane, folder);
    CHECK_OK(relume_image_create(&image, BUMP_SIDE, BUMP_SIDE, 3));
    for (int i = 0; i < BUMP_LIGHTS; i++) {
        for (int k = 0; k < 3 * PIXELS; k++) {
            const int x = k / 3 % BUMP_SIDE, y = k / 3 / BUMP_SIDE;
            image.data[k] = (float)reflectance(x, y, k % 3, towards(i, x, y));
        }
        snprintf(path, sizeof path, "%s/l%d.exr", folder, i);
        CHECK_OK(relume_image_save(&image, path, NULL));
    }
    relume_image_destroy(&image);
    CHECK_OK(relume_capture_open(&capture, folder, NULL));
    return capture;
}

static relume_coder *make_coder(const relume_capture *capture, const struct relume_basis *basis,
                                int coefficients, bool luminance)
{
    relume_coder *coder;
    CHECK_OK(relume_coder_learn(
        &coder, basis, capture,
        relume_coder_params(.coefficients = coefficients, .luminance = luminance),
        relume_project_params(.domain = RELUME_DOMAIN_LINEAR)));
    return coder;
}

// Planes [plane][y][x], in bands of `height` rows; `own` false: of carried-over samples alone.
static void fit(float *planes, const relume_capture *capture, const relume_coder *coder, bool own,
                int height, int threads)
{
    relume_table *table;
    struct near_fit *seen;
    const size_t size = 3 * BUMP_LIGHTS * (size_t)height * BUMP_SIDE;
    const int n = relume_coder_info(coder)->planes;
    float *guess = calloc(size, sizeof *guess), *samples = calloc(size, sizeof *samples);
    float *band = calloc((size_t)(n * height * BUMP_SIDE), sizeof *band);
    CHECK_OK(relume_table_open(&table, capture, 0, relume_table_params(.threads = threads)));
    assert_true(relume_table_is_near(table));
    CHECK_OK(near_fit_create(&seen, coder, table, BUMP_SIDE, BUMP_SIDE, threads));
    for (int y = 0; y < BUMP_SIDE; y += height) {
        const int rows = BUMP_SIDE - y < height ? BUMP_SIDE - y : height;
        const size_t pixels = (size_t)rows * BUMP_SIDE;
        CHECK_OK(relume_table_read_near(table, rows, guess, samples));
        if (own)
            CHECK_OK(near_fit_apply(seen, y, rows, samples, guess, band));
        else
            CHECK_OK(relume_coder_apply(coder, guess, 3 * pixels, pixels, band, pixels));
        for (int p = 0; p < n; p++)
            memcpy(planes + p * PIXELS + y * BUMP_SIDE, band + (size_t)p * pixels,
                   pixels * sizeof *band);
    }
    near_fit_destroy(&seen);
    relume_table_destroy(&table);
    free(guess);
    free(samples);
    free(band);
}

static double value(const relume_coder *coder, const float *planes, int pixel, int channel,
                    struct relume_vec3 d)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    float weights[3 * MOST_PLANES], constant[3];
    relume_coder_weights(coder, d, weights, constant);
    double sum = (double)constant[channel];
    for (int k = 0; k < info->coefficients; k++)
        sum += (double)weights[channel * info->coefficients + k] *
               (double)planes[relume_coder_plane(info, k, channel) * PIXELS + pixel];
    return info->luminance ? sum * (double)planes[(info->coefficients + channel) * PIXELS + pixel]
                           : sum;
}

static double rms_error(const relume_coder *coder, const float *planes)
{
    double squares = 0.0;
    for (int i = 0; i < BUMP_LIGHTS; i++)
        for (int k = 0; k < PIXELS; k++)
            for (int c = 0; c < 3; c++) {
                const double d = value(coder, planes, k, c, bump_light(i)) -
                                 reflectance(k % BUMP_SIDE, k / BUMP_SIDE, c, bump_light(i));
                squares += d * d / (3 * PIXELS * BUMP_LIGHTS);
            }
    return sqrt(squares);
}

// The guess, a tenth of the weight, is all that is wrong with what the basis can express.
static void a_polynomial_is_met(void **state)
{
    (void)state;
    static float planes[MOST_PLANES * PIXELS];
    char folder[64];
    relume_capture *capture = open_quadratic(folder);
    relume_coder *coder = make_coder(capture, &relume_basis_ptm, 6, false);
    fit(planes, capture, coder, false, BUMP_SIDE, 1);
    const double carried = rms_error(coder, planes);
    fit(planes, capture, coder, true, BUMP_SIDE, 1);
    const double fitted = rms_error(coder, planes);
    if (!(fitted < 0.35 * carried && fitted < 0.015))
        fail_msg("fitted: off by %g; carried over: %g", fitted, carried);
    relume_coder_destroy(&coder);
    bump_close(&capture, folder);
}

// A matte plane under near lights: every basis shows n.l under distant ones, as it did when samples
// were carried over; learned and luminance coders too.
static void matte_planes_stay_exact(void **state)
{
    (void)state;
    static const struct {
        const struct relume_basis *basis;
        int coefficients;
        bool luminance;
    } cases[] = {{&relume_basis_ptm, 6, false}, {&relume_basis_ptm, 6, true},
                 {&relume_basis_hsh, 9, false}, {&relume_basis_sh, 9, false},
                 {&relume_basis_dct, 9, false}, {&relume_basis_pca, 4, false}};
    static float planes[MOST_PLANES * PIXELS];
    const struct bump s = {.near = true, .flat = true, .normal_of_plane = {0.05, -0.03, 1}};
    char folder[64];
    relume_capture *capture = bump_open(&s, folder);
    const struct relume_vec3 n = vec3_unit(s.normal_of_plane);
    for (size_t b = 0; b < sizeof cases / sizeof *cases; b++) {
        relume_coder *coder =
            make_coder(capture, cases[b].basis, cases[b].coefficients, cases[b].luminance);
        double own = 0.0, carried = 0.0;
        assert_true(near_fit_suits(coder));
        for (int of_own = 0; of_own < 2; of_own++) {
            fit(planes, capture, coder, of_own, BUMP_SIDE, 2);
            for (int i = 0; i < BUMP_LIGHTS; i++)
                for (int k = 0; k < PIXELS; k++) {
                    const double d = value(coder, planes, k, 0, bump_light(i)) -
                                     0.7 * vec3_dot(n, bump_light(i));
                    *(of_own ? &own : &carried) += d * d / (PIXELS * BUMP_LIGHTS);
                }
        }
        // what PTM and the far side of SH cannot express depends on the directions: 1 % of the
        // albedo
        if (!(sqrt(own) < fmax(1.5 * sqrt(carried), 7e-3)))
            fail_msg("%s: RMS %g; carried over: %g", cases[b].basis->name, sqrt(own),
                     sqrt(carried));
        relume_coder_destroy(&coder);
    }
    bump_close(&capture, folder);
}

static void bands_and_threads_agree(void **state)
{
    (void)state;
    static float whole[MOST_PLANES * PIXELS], banded[MOST_PLANES * PIXELS];
    char folder[64];
    relume_capture *capture = open_quadratic(folder);
    relume_coder *coder = make_coder(capture, &relume_basis_ptm, 6, false);
    fit(whole, capture, coder, true, BUMP_SIDE, 1);
    fit(banded, capture, coder, true, 7, 3);
    assert_memory_equal(whole, banded, 18 * PIXELS * sizeof *whole);
    relume_coder_destroy(&coder);
    bump_close(&capture, folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_polynomial_is_met),
        cmocka_unit_test(matte_planes_stay_exact),
        cmocka_unit_test(bands_and_threads_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
