// test_heldout.c - tests of include/relume/encode/heldout.h: coders judged by lights that they have
// not seen
#include "format/coder/coding.h"

#include "test.h"

#include "capture_fixture.h"

enum { WIDTH = 23, HEIGHT = 34, LIGHTS = 11, LEFT_OUT = 3, FOLDS = 4 };

static char folder[64], part_path[96], rest_path[96], pack_path[96];

static int setup(void **state)
{
    (void)state;
    const struct fixture f = {.width = WIDTH,
                              .height = HEIGHT,
                              .lights = LIGHTS,
                              .views = 2,
                              .hemisphere = true,
                              .mask = true};
    test_folder(folder);
    fixture_write(&f, folder);
    snprintf(part_path, sizeof part_path, "%s/part.json", folder);
    snprintf(rest_path, sizeof rest_path, "%s/rest.json", folder);
    snprintf(pack_path, sizeof pack_path, "%s/pack.exr", folder);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

// A manifest of those lights whose number is (or is not) `fold` modulo FOLDS.
static void write_part(const relume_capture *capture, const char *path, int fold, bool left_out)
{
    struct relume_manifest m = *relume_capture_manifest(capture);
    struct relume_vec3 directions[LIGHTS];
    const char *images[2][LIGHTS];
    struct relume_manifest_view view[2] = {m.view[0], m.view[1]};
    int n = 0;
    for (int i = 0; i < m.lights; i++) {
        if ((i % FOLDS == fold) != left_out)
            continue;
        directions[n] = m.directions[i];
        for (int v = 0; v < 2; v++)
            images[v][n] = strrchr(m.view[v].images[i], '/') + 1;
        n++;
    }
    for (int v = 0; v < 2; v++) {
        view[v].images = images[v];
        view[v].mask = "mask.exr";
    }
    m.lights = n;
    m.directions = directions;
    m.view = view;
    CHECK_OK(relume_manifest_write(&m, path, NULL));
}

struct coding {
    const struct relume_basis *basis;
    int coefficients;
    enum relume_domain domain;
    struct relume_heldout_store store;
    bool choose;
    struct relume_transfer display;
};

// The same by real files: one for each fold, evaluated on the lights that it has not seen.
static struct relume_heldout_quality by_files(const relume_capture *capture, const struct coding *c)
{
    struct relume_heldout_quality sum = {0.0, 0.0, 0.0};
    double images = 0.0, mse = 0.0;
    for (int fold = 0; fold < FOLDS; fold++) {
        relume_capture *part, *rest;
        relume_coder *coder;
        relume_pack *pack;
        struct relume_evaluation e;
        write_part(capture, part_path, fold, false);
        write_part(capture, rest_path, fold, true);
        CHECK_OK(relume_capture_open(&part, part_path, NULL));
        CHECK_OK(relume_capture_open(&rest, rest_path, NULL));
        CHECK_OK(relume_coder_learn(
            &coder, c->basis, part,
            relume_coder_params(.coefficients = c->coefficients, .choose = c->choose),
            relume_project_params(.domain = c->domain, .display = c->display)));
        CHECK_OK(relume_pack_encode(
            part, coder, pack_path, NULL,
            relume_pack_encode_params(.domain = c->domain, .display = c->display,
                                      .storage = c->store.storage, .step = c->store.step,
                                      .books = c->store.books, .share = c->store.share)));
        CHECK_OK(relume_pack_open(&pack, pack_path, NULL));
        CHECK_OK(relume_evaluate(&e, pack, rest, NULL));
        const double n = (double)e.images;
        sum.psnr_db += n * e.psnr_db;
        sum.ssim += n * e.ssim;
        mse += n * pow(10.0, -0.1 * e.psnr_pooled_db);
        images += n;
        relume_evaluation_destroy(&e);
        relume_pack_destroy(&pack);
        relume_coder_destroy(&coder);
        relume_capture_destroy(&part);
        relume_capture_destroy(&rest);
    }
    assert_true(images == 2.0 * LIGHTS);
    sum.psnr_db /= images;
    sum.ssim /= images;
    sum.psnr_pooled_db = -10.0 * log10(mse / images);
    return sum;
}

// The path in memory gives the figures of files and eval.
static void test_against_files(void **state)
{
    (void)state;
    const struct relume_books_params two = {.codes = 16, .stages = 2, .seed = 3};
    const struct relume_transfer logarithm = {.curve = RELUME_CURVE_LOG, .gamma = 0.01f};
    const struct coding codings[] = {
        {.basis = &relume_basis_sh, 4, RELUME_DOMAIN_LINEAR, .store.step = RELUME_STEP_PLANE},
        {.basis = &relume_basis_sh, 4, RELUME_DOMAIN_DISPLAY, .store.step = RELUME_STEP_COMMON},
        {.basis = &relume_basis_sh, 4, RELUME_DOMAIN_DISPLAY, .store.storage = RELUME_STORE_HALF},
        {.basis = &relume_basis_table, .domain = RELUME_DOMAIN_DISPLAY},
        {.basis = &relume_basis_table, .store.storage = RELUME_STORE_16},
        {.basis = &relume_basis_hsh, 4, .store.storage = RELUME_STORE_10},
        {.basis = &relume_basis_pca, 5, RELUME_DOMAIN_DISPLAY, .store.step = RELUME_STEP_COMMON},
        {.basis = &relume_basis_pca, 3, .store.storage = RELUME_STORE_12},
        {.basis = &relume_basis_pca, 4, RELUME_DOMAIN_DISPLAY, .choose = true},
        {.basis = &relume_basis_table, .domain = RELUME_DOMAIN_DISPLAY, .choose = true},
        {.basis = &relume_basis_sh, 4, .store = {.storage = RELUME_STORE_HALF, .books = &two}},
        {.basis = &relume_basis_pca, 4, .store = {.books = &two, .share = true}},
        {.basis = &relume_basis_eigen, 4, RELUME_DOMAIN_DISPLAY, .display = logarithm},
        {.basis = &relume_basis_table, .domain = RELUME_DOMAIN_DISPLAY, .display = logarithm},
    };
    relume_capture *capture;
    CHECK_OK(relume_capture_open(&capture, folder, NULL));
    for (size_t i = 0; i < sizeof codings / sizeof *codings; i++) {
        const struct coding *c = &codings[i];
        relume_heldout *h;
        struct relume_heldout_quality before, after;
        CHECK_OK(
            relume_heldout_open(&h, capture,
                                relume_heldout_params(.leave_out = LEFT_OUT, .domain = c->domain,
                                                      .display = c->display)));
        assert_int_equal(relume_heldout_info(h)->folds, FOLDS);
        assert_int_equal(relume_heldout_info(h)->fewest, 8);
        CHECK_OK(relume_heldout_measure(
            h, c->basis, relume_coder_params(.coefficients = c->coefficients, .choose = c->choose),
            &c->store, 1, &before, &after));
        const struct relume_heldout_quality want = by_files(capture, c);
        print_message("%s %d: %.4f dB before storing, %.4f dB after\n", c->basis->name,
                      c->coefficients, before.psnr_db, after.psnr_db);
        // One quantiser: the same codes. What is left is the order of sums in single precision,
        // 1e-7, by which one display value in thousands falls on the other side of a half.
        // Files take logarithms back by straight pieces (curve.h), which is ten times that.
        const double more = c->display.curve == RELUME_CURVE_LOG ? 10.0 : 1.0;
        CHECK_NEAR(after.psnr_db, want.psnr_db, more * 1e-4);
        CHECK_NEAR(after.psnr_pooled_db, want.psnr_pooled_db, more * 3e-6);
        CHECK_NEAR(after.ssim, want.ssim, more * 3e-8);
        assert_true(fabs(before.psnr_pooled_db - after.psnr_pooled_db) > 1e-7);  // it was stored
        relume_heldout_destroy(&h);
    }
    relume_capture_destroy(&capture);
}

// What a picture shows at its own exposure, with a gamma of 2.2.
static double tone(double gain, double v)
{
    return pow(fmin(fmax(gain * v, 0.0), 1.0), 1.0 / 2.2);
}

// Of the mean over all lights, which is what one harmonic is, in double precision.
static double toned_error(const relume_capture *capture, int view, double *count)
{
    struct relume_image light[LIGHTS] = {{0}}, mask;
    double sum = 0.0;
    CHECK_OK(relume_capture_mask(&mask, capture, view, NULL));
    for (int i = 0; i < LIGHTS; i++)
        CHECK_OK(relume_capture_image(&light[i], capture, view, i, NULL));
    const size_t pixels = (size_t)light[0].width * (size_t)light[0].height;
    for (size_t i = 0; i < LIGHTS; i++) {
        struct relume_image seen;
        CHECK_OK(relume_image_create(&seen, light[0].width, light[0].height, 3));
        for (size_t x = 0; x < 3 * pixels; x++)
            seen.data[x] = mask.data && mask.data[x / 3] <= 0.5f ? 0.0f : light[i].data[x];
        const double gain = exp2(relume_tone_meter(&seen));
        relume_image_destroy(&seen);
        for (size_t x = 0; x < 3 * pixels; x++) {
            double mean = 0.0;
            for (int j = 0; j < LIGHTS; j++)
                mean += (double)light[j].data[x] / LIGHTS;
            const double d = tone(gain, mean) - tone(gain, (double)light[i].data[x]);
            const bool inside = !mask.data || mask.data[x / 3] > 0.5f;
            sum += inside ? d * d : 0.0;
            *count += inside;
        }
    }
    for (int i = 0; i < LIGHTS; i++)
        relume_image_destroy(&light[i]);
    relume_image_destroy(&mask);
    return sum;
}

static void test_each_at_its_own_exposure(void **state)
{
    (void)state;
    relume_capture *capture, *one;
    relume_heldout *h;
    struct relume_manifest m;
    struct relume_manifest_view view;
    struct relume_heldout_quality before, after;
    const struct relume_heldout_store store = {.storage = RELUME_STORE_HALF};
    double count = 0.0;
    // one view: exposures are for all of a light's pixels
    CHECK_OK(relume_capture_open(&capture, folder, NULL));
    m = *relume_capture_manifest(capture);
    view = m.view[0];
    m.view = &view;
    m.views = 1;
    const char *images[LIGHTS];
    for (int i = 0; i < LIGHTS; i++)
        images[i] = strrchr(view.images[i], '/') + 1;
    view.images = images;
    view.mask = "mask.exr";
    CHECK_OK(relume_manifest_write(&m, part_path, NULL));
    CHECK_OK(relume_capture_open(&one, part_path, NULL));
    CHECK_OK(relume_heldout_open(
        &h, one,
        relume_heldout_params(.test = one, .domain = RELUME_DOMAIN_LINEAR, .tone_mapped = true)));
    CHECK_OK(relume_heldout_measure(h, &relume_basis_sh,
                                    relume_coder_params(.coefficients = 1, .no_ridge = true),
                                    &store, 1, &before, &after));
    const double want = -10.0 * log10(toned_error(one, 0, &count) / count);
    // the exposure of samples that were decoded, and halves of the mean
    CHECK_NEAR(before.psnr_pooled_db, want, 1e-3);
    CHECK_NEAR(after.psnr_pooled_db, want, 1e-2);
    relume_heldout_destroy(&h);
    relume_capture_destroy(&one);
    relume_capture_destroy(&capture);
}

// A second capture, and the same figures for any number of threads.
static void test_second_capture(void **state)
{
    (void)state;
    relume_capture *capture, *part, *rest;
    CHECK_OK(relume_capture_open(&capture, folder, NULL));
    write_part(capture, part_path, 1, false);
    write_part(capture, rest_path, 1, true);
    CHECK_OK(relume_capture_open(&part, part_path, NULL));
    CHECK_OK(relume_capture_open(&rest, rest_path, NULL));
    const struct relume_books_params books = {.codes = 64};
    const struct relume_heldout_store store[3] = {
        {.storage = RELUME_STORE_8}, {.storage = RELUME_STORE_16}, {.books = &books}};
    struct relume_heldout_quality before[2], after[2][3];
    for (int i = 0; i < 2; i++) {
        relume_heldout *h;
        CHECK_OK(relume_heldout_open(&h, part,
                                     relume_heldout_params(.test = rest, .threads = i ? 7 : 1)));
        assert_int_equal(relume_heldout_info(h)->folds, 1);
        assert_int_equal(relume_heldout_info(h)->judged, 3);
        CHECK_OK(relume_heldout_measure(h, &relume_basis_sh, relume_coder_params(.coefficients = 4),
                                        store, 3, &before[i], after[i]));
        relume_heldout_destroy(&h);
    }
    assert_memory_equal(&before[0], &before[1], sizeof before[0]);
    assert_memory_equal(after[0], after[1], sizeof after[0]);
    CHECK_NEAR(after[0][1].psnr_pooled_db, before[0].psnr_pooled_db, 1e-3);  // 16 bits lose nothing
    relume_coder *coder;
    CHECK_OK(relume_coder_learn(&coder, &relume_basis_sh, part,
                                relume_coder_params(.coefficients = 4), NULL));
    for (int i = 0; i < 3; i++) {
        relume_pack *pack;
        struct relume_evaluation e;
        CHECK_OK(relume_pack_encode(
            part, coder, pack_path, NULL,
            relume_pack_encode_params(.storage = store[i].storage, .books = store[i].books)));
        CHECK_OK(relume_pack_open(&pack, pack_path, NULL));
        CHECK_OK(relume_evaluate(&e, pack, rest, NULL));
        CHECK_NEAR(after[0][i].psnr_db, e.psnr_db, 0.001);
        CHECK_NEAR(after[0][i].ssim, e.ssim, 1e-5);
        relume_evaluation_destroy(&e);
        relume_pack_destroy(&pack);
    }
    relume_coder_destroy(&coder);
    relume_capture_destroy(&capture);
    relume_capture_destroy(&part);
    relume_capture_destroy(&rest);
}

// Where memory is short, bands of rows represent the whole: the same object, fewer pixels.
static void test_bands(void **state)
{
    (void)state;
    const struct fixture f = {.width = 20, .height = 400, .lights = 5, .views = 1};
    char tall[64];
    test_folder(tall);
    fixture_write(&f, tall);
    relume_capture *capture;
    relume_heldout *h;
    struct relume_heldout_quality whole, bands;
    CHECK_OK(relume_capture_open(&capture, tall, NULL));
    CHECK_OK(relume_heldout_open(&h, capture, NULL));
    assert_int_equal(relume_heldout_info(h)->pixels, 20 * 400);
    CHECK_OK(relume_heldout_measure(h, &relume_basis_table, NULL, NULL, 0, &whole, NULL));
    relume_heldout_destroy(&h);
    // a third of 20 x 400 pixels x 5 lights x 19 bytes
    CHECK_OK(relume_heldout_open(&h, capture, relume_heldout_params(.memory = 260000)));
    assert_int_equal(relume_heldout_info(h)->all_pixels, 20 * 400);
    assert_int_equal(relume_heldout_info(h)->pixels, 20 * 64 * 2);
    CHECK_OK(relume_heldout_measure(h, &relume_basis_table, NULL, NULL, 0, &bands, NULL));
    CHECK_NEAR(bands.psnr_db, whole.psnr_db, 1.0);  // the pattern repeats down the image
    CHECK_NEAR(bands.ssim, whole.ssim, 0.05);
    relume_heldout_destroy(&h);
    relume_capture_destroy(&capture);
    test_folder_remove(tall);
}

static void test_refusals(void **state)
{
    (void)state;
    relume_capture *capture, *part;
    relume_heldout *h = (void *)1;
    struct test_log log;
    struct relume_heldout_quality before;
    test_log_init(&log);
    CHECK_OK(relume_capture_open(&capture, folder, NULL));
    assert_int_equal(relume_heldout_open(
                         &h, capture, relume_heldout_params(.log = &log.log, .leave_out = LIGHTS)),
                     RELUME_EINVAL);
    assert_null(h);
    assert_non_null(strstr(log.text, "leaves none"));
    const struct fixture f = {.width = 8, .height = 8, .lights = 4, .views = 1};
    char small[64];
    test_folder(small);
    fixture_write(&f, small);
    CHECK_OK(relume_capture_open(&part, small, NULL));
    assert_int_equal(
        relume_heldout_open(&h, capture, relume_heldout_params(.log = &log.log, .test = part)),
        RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "8 x 8"));
    // a fold that has too few lights says so, and leaves the object as it was
    CHECK_OK(relume_heldout_open(&h, part, relume_heldout_params(.leave_out = 2)));
    assert_int_equal(relume_heldout_measure(h, &relume_basis_sh,
                                            relume_coder_params(.log = &log.log, .coefficients = 4),
                                            NULL, 0, &before, NULL),
                     RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "4 coefficients"));
    CHECK_OK(relume_heldout_measure(h, &relume_basis_sh, relume_coder_params(.coefficients = 1),
                                    NULL, 0, &before, NULL));
    relume_heldout_destroy(&h);
    relume_capture_destroy(&capture);
    relume_capture_destroy(&part);
    test_folder_remove(small);
}

static void check_hull(const double (*points)[2], const char *want)
{
    const int n = (int)strlen(want);
    double rate[16] = {0.0}, quality[16] = {0.0};
    bool on[16];
    for (int i = 0; i < n; i++) {
        rate[i] = points[i][0];
        quality[i] = points[i][1];
    }
    relume_rate_hull(on, rate, quality, n);
    for (int i = 0; i < n; i++)
        if (on[i] != (want[i] == 'x'))
            fail_msg("point %d of '%s' is %son the hull", i, want, on[i] ? "" : "not ");
}

// By hand, on a logarithmic axis; then against the definition, for random points.
static void test_hull(void **state)
{
    (void)state;
    const double nan = (double)NAN;
    check_hull((const double[][2]){{1, 10}, {2, 20}, {4, 25}, {8, 26}}, "xxxx");
    check_hull((const double[][2]){{8, 26}, {4, 12}, {2, 20}, {1, 10}}, "x.xx");
    check_hull((const double[][2]){{1, 10}, {2, 11}, {4, 30}}, "x.x");
    check_hull((const double[][2]){{1, 10}, {2, 20}, {4, 30}}, "xxx");  // on one line
    check_hull((const double[][2]){{1, 10}, {1, 12}, {2, 5}, {3, nan}, {0, 90}, {5, 12}}, ".x....");
    check_hull((const double[][2]){{3, nan}, {-1, 2}}, "..");
    check_hull((const double[][2]){{3, 7}}, "x");
    uint32_t seed = 5;
    for (int round = 0; round < 200; round++) {
        enum { N = 12 };
        double rate[N], quality[N];
        bool on[N];
        for (int i = 0; i < N; i++) {
            rate[i] = exp(3.0 * test_uniform(&seed));
            quality[i] = 40.0 * test_uniform(&seed);
        }
        relume_rate_hull(on, rate, quality, N);
        for (int i = 0; i < N; i++) {  // beaten by a point, or by a mixture of two?
            bool beaten = false;
            for (int a = 0; a < N; a++) {
                beaten |= a != i && rate[a] <= rate[i] && quality[a] >= quality[i];
                for (int b = 0; b < N; b++) {
                    if (rate[a] >= rate[i] || rate[b] <= rate[i])
                        continue;
                    const double t = log(rate[i] / rate[a]) / log(rate[b] / rate[a]);
                    beaten |= quality[a] + t * (quality[b] - quality[a]) > quality[i] + 1e-9;
                }
            }
            assert_int_equal(on[i], !beaten);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_files),  cmocka_unit_test(test_each_at_its_own_exposure),
        cmocka_unit_test(test_second_capture), cmocka_unit_test(test_bands),
        cmocka_unit_test(test_refusals),       cmocka_unit_test(test_hull),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
