// test_pack_books.c - files with codebooks against files with planes, and against themselves
#include "test.h"

#include "capture_fixture.h"
#include "core/base/memory.h"
#include "pack_parts.h"

static char folder[64], path[96], other[96];

enum { W = 11, H = 37, PIXELS = W * H };
static const struct fixture planar = {.width = W, .height = H, .lights = 12, .views = 1};
static const struct fixture slab = {
    .width = W, .height = H, .lights = 12, .views = 3, .depth = true, .mask = true};

static int setup(void **state)
{
    (void)state;
    test_folder(folder);
    snprintf(path, sizeof path, "%s/books.exr", folder);
    snprintf(other, sizeof other, "%s/planes.exr", folder);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

static void encode(const char *to, const struct relume_books_params *books, bool share,
                   enum relume_storage storage)
{
    CHECK_OK(fixture_encode(
        folder, to, &relume_basis_sh, 4,
        relume_pack_encode_params(.storage = storage, .books = books, .share = share)));
}

static relume_pack *open_pack(const char *from)
{
    relume_pack *pack;
    CHECK_OK(relume_pack_open(&pack, from, NULL));
    return pack;
}

static double difference(const char *a, const char *b, int view)
{
    const struct relume_light light = {.direction = {0.4, 0.3, 0.8}, .rgb = {1, 1, 1}};
    relume_pack *packs[2] = {open_pack(a), open_pack(b)};
    struct relume_image image[2] = {{0}};
    double most = 0.0;
    for (int i = 0; i < 2; i++) {
        const struct relume_codes *codes;
        CHECK_OK(relume_pack_codes(&codes, packs[i], view));
        CHECK_OK(relume_relight(&image[i], codes, &light, 1, NULL));
    }
    for (int i = 0; i < 3 * PIXELS; i++)
        most = fmax(most, fabs((double)(image[0].data[i] - image[1].data[i])));
    for (int i = 0; i < 2; i++) {
        relume_image_destroy(&image[i]);
        relume_pack_destroy(&packs[i]);
    }
    return most;
}

struct form {
    const char *name;
    struct relume_books_params params;
    int books;
};
static const struct form forms[] = {
    {"one", {.codes = PIXELS}, 1},
    {"two stages", {.codes = PIXELS, .stages = 2}, 2},
    {"luma", {.codes = PIXELS, .split = RELUME_SPLIT_LUMA}, 2},
    {"product", {.codes = PIXELS, .split = RELUME_SPLIT_PRODUCT, .groups = 3}, 3},
    {"both", {.codes = PIXELS, .split = RELUME_SPLIT_LUMA, .stages = 2}, 4},
    {"random start", {.codes = PIXELS, .start = RELUME_START_RANDOM}, 1},
};

// As many codes as pixels: nothing is lost but what 16 bits lose, in every form.
static void test_forms(void **state)
{
    (void)state;
    fixture_write(&planar, folder);
    encode(other, NULL, false, RELUME_STORE_16);
    for (size_t f = 0; f < sizeof forms / sizeof *forms; f++) {
        encode(path, &forms[f].params, false, RELUME_STORE_16);
        relume_pack *pack = open_pack(path);
        const struct relume_pack_info *info = relume_pack_info(pack);
        assert_int_equal(info->books, forms[f].books);
        assert_int_equal(info->codes, PIXELS);
        // 4 functions below 1.1, steps of 2^-16 of a range below 2, 4 books
        CHECK_NEAR(difference(path, other, 0), 0.0, 4e-4);
        assert_true(info->report.store_rms < 1e-4);
        relume_pack_destroy(&pack);
    }
}

static double loss(const struct relume_books_params *params)
{
    encode(path, params, true, RELUME_STORE_16);
    relume_pack *pack = open_pack(path);
    const double rms = relume_pack_info(pack)->report.store_rms;
    assert_true(rms > 0.0 && rms < 1.0);
    relume_pack_destroy(&pack);
    return rms;
}

static void test_more_is_better(void **state)
{
    (void)state;
    fixture_write(&slab, folder);
    const double few = loss(relume_books_params(.codes = 4, .start = RELUME_START_SPLIT));
    const double more = loss(relume_books_params(.codes = 64, .start = RELUME_START_SPLIT));
    const double stages =
        loss(relume_books_params(.codes = 4, .stages = 3, .start = RELUME_START_SPLIT));
    assert_true(more < 0.5 * few);
    assert_true(stages < 0.7 * few);
}

// The report is what relighting with the captured lights shows, on the rows that it looks at.
static void test_report(void **state)
{
    (void)state;
    fixture_write(&planar, folder);
    encode(path, relume_books_params(.codes = 10), false, RELUME_STORE_16);
    encode(other, NULL, false, RELUME_STORE_16);
    relume_pack *packs[2] = {open_pack(path), open_pack(other)};
    const struct relume_coder_info *coder = relume_coder_info(relume_pack_info(packs[0])->coder);
    double sum = 0.0;
    for (int l = 0; l < coder->lights; l++) {
        const struct relume_light light = {.direction = coder->directions[l], .rgb = {1, 1, 1}};
        struct relume_image image[2] = {{0}};
        for (int i = 0; i < 2; i++) {
            const struct relume_codes *codes;
            CHECK_OK(relume_pack_codes(&codes, packs[i], 0));
            CHECK_OK(relume_relight(&image[i], codes, &light, 1, NULL));
        }
        for (int y = 0; y < H; y += 16)
            for (int x = 0; x < 3 * W; x++) {
                const double d =
                    (double)(image[0].data[3 * W * y + x] - image[1].data[3 * W * y + x]);
                sum += d * d;
            }
        relume_image_destroy(&image[0]);
        relume_image_destroy(&image[1]);
    }
    const double rms = sqrt(sum / (3.0 * 3 * W * coder->lights));
    CHECK_NEAR(relume_pack_info(packs[0])->report.store_rms, rms, 0.01 * rms);
    relume_pack_destroy(&packs[0]);
    relume_pack_destroy(&packs[1]);
}

static void test_share(void **state)
{
    (void)state;
    static const enum relume_storage storages[] = {RELUME_STORE_8, RELUME_STORE_10, RELUME_STORE_12,
                                                   RELUME_STORE_16, RELUME_STORE_HALF};
    fixture_write(&slab, folder);
    for (int share = 0; share < 2; share++)
        for (size_t s = 0; s < 5; s++) {
            encode(path, relume_books_params(.codes = 20, .stages = 2, .split = RELUME_SPLIT_LUMA),
                   share, storages[s]);
            relume_pack *pack = open_pack(path);
            const struct relume_codes *codes[3];
            assert_true(relume_pack_info(pack)->shared == share);
            assert_int_equal(relume_pack_info(pack)->storage, storages[s]);
            for (int v = 0; v < slab.views; v++) {
                struct relume_image plane;
                CHECK_OK(relume_pack_codes(&codes[v], pack, v));
                assert_int_equal(codes[v]->books, 4);
                assert_int_equal(codes[v]->book_codes[3], 20 + 1);  // one of nothing, for masks
                CHECK_OK(relume_pack_mask(&plane, pack, v));
                assert_non_null(plane.data);
                relume_image_destroy(&plane);
            }
            assert_true((codes[0]->vectors == codes[2]->vectors) == share);
            check_parts(pack, 2);
            relume_pack_drop(pack, 1);
            CHECK_OK(relume_pack_codes(&codes[1], pack, 1));
            relume_pack_destroy(&pack);
        }
}

// A learned joint basis and a luminance basis.
static void test_other_bases(void **state)
{
    (void)state;
    fixture_write(&planar, folder);
    relume_capture *capture;
    CHECK_OK(relume_capture_open(&capture, folder, NULL));
    for (int luminance = 0; luminance < 2; luminance++)
        for (int books = 0; books < 2; books++) {
            relume_coder *coder;
            CHECK_OK(relume_coder_learn(
                &coder, luminance ? &relume_basis_sh : &relume_basis_pca, capture,
                relume_coder_params(.coefficients = 4, .luminance = luminance), NULL));
            CHECK_OK(relume_pack_encode(
                capture, coder, books ? path : other, NULL,
                relume_pack_encode_params(.storage = RELUME_STORE_16,
                                          .books = books ? relume_books_params(.codes = PIXELS)
                                                         : NULL)));
            relume_coder_destroy(&coder);
            if (books)
                CHECK_NEAR(difference(path, other, 0), 0.0, 4e-4);
        }
    relume_capture_destroy(&capture);
}

static void expect(const struct relume_books_params *given, relume_status status, const char *word)
{
    struct test_log log;
    struct relume_books_params p = *given;
    test_log_init(&log);
    p.log = &log.log;
    unlink(path);
    assert_int_equal(
        fixture_encode(folder, path, &relume_basis_sh, 4, relume_pack_encode_params(.books = &p)),
        status);
    assert_int_equal(log.lines, 1);
    assert_non_null(strstr(log.text, word));
    assert_int_not_equal(access(path, F_OK), 0);
}

static void test_bad_params(void **state)
{
    (void)state;
    fixture_write(&planar, folder);
    expect(relume_books_params(.codes = PIXELS + 1), RELUME_EUNFIT, "407 pixels");
    expect(relume_books_params(.codes = 2, .stages = 9), RELUME_EINVAL, "at most 8");
    expect(relume_books_params(.codes = 2, .stages = 5, .split = RELUME_SPLIT_LUMA), RELUME_EINVAL,
           "at most 8");
    expect(relume_books_params(.codes = 2, .split = RELUME_SPLIT_PRODUCT, .groups = 5),
           RELUME_EINVAL, "5 groups of 4");
    expect(relume_books_params(.codes = 65537), RELUME_EINVAL, "65536");
    expect(relume_books_params(.codes = 2, .dither = 2.0f), RELUME_EINVAL, "dither");
}

static void test_threads(void **state)
{
    (void)state;
    static const int threads[] = {1, 2, 7};
    fixture_write(&slab, folder);
    for (int dither = 0; dither < 2; dither++) {
        void *first = NULL;
        size_t first_size = 0;
        for (int t = 0; t < 3; t++) {
            size_t size;
            CHECK_OK(fixture_encode(
                folder, path, &relume_basis_sh, 4,
                relume_pack_encode_params(.threads = threads[t], .share = dither,
                                          .books = relume_books_params(.codes = 17, .stages = 2,
                                                                       .dither =
                                                                           dither ? 0.7f : 0.0f))));
            void *bytes = test_read(path, &size);
            if (!first) {
                first = bytes;
                first_size = size;
                continue;
            }
            assert_int_equal(size, first_size);
            assert_memory_equal(bytes, first, size);
            free(bytes);
        }
        free(first);
    }
}

enum { SIDE = 96, AREA = 8 };

// A wall that grows brighter to the right and down, under lights that differ in brightness alone:
// its coefficients lie on one line.
static double wall(int pixel)
{
    return 0.2 + 0.6 * (pixel % SIDE + 0.5 * (double)(pixel / SIDE)) / (1.5 * SIDE);
}

static void write_wall(void)
{
    struct relume_vec3 lights[9];
    struct relume_image image;
    char name[128];
    CHECK_OK(relume_directions_make(lights, 9, relume_pattern_find("hammersley"), NULL));
    CHECK_OK(relume_image_create(&image, SIDE, SIDE, 3));
    snprintf(name, sizeof name, "%s/wall.lp", folder);
    FILE *lp = fopen(name, "w");
    assert_non_null(lp);
    fprintf(lp, "9\n");
    for (int i = 0; i < 9; i++) {
        for (int p = 0; p < 3 * SIDE * SIDE; p++)
            image.data[p] = (float)(wall(p / 3) * (0.7 + 0.3 * lights[i].z));
        snprintf(name, sizeof name, "%s/wall%d.exr", folder, i);
        CHECK_OK(relume_image_save(&image, name, NULL));
        fprintf(lp, "wall%d.exr %.9g %.9g %.9g\n", i, lights[i].x, lights[i].y, lights[i].z);
    }
    assert_int_equal(fclose(lp), 0);
    relume_image_destroy(&image);
}

static void encode_wall(float dither)
{
    char name[128];
    relume_capture *capture;
    relume_coder *coder;
    snprintf(name, sizeof name, "%s/wall.lp", folder);
    CHECK_OK(relume_capture_open(&capture, name, NULL));
    CHECK_OK(relume_coder_learn(&coder, &relume_basis_sh, capture,
                                relume_coder_params(.coefficients = 4), NULL));
    CHECK_OK(relume_pack_encode(
        capture, coder, path, NULL,
        relume_pack_encode_params(.books = relume_books_params(.codes = 8, .dither = dither,
                                                               .start = RELUME_START_SPLIT))));
    relume_coder_destroy(&coder);
    relume_capture_destroy(&capture);
}

// Between two codes the mean of a small area follows the wall, where without dither it is that of
// one code or two: an eighth of the range wide. Half the step's height would be half the error; the
// area's own size, two of the pattern's periods, takes its part of both.
static void test_dither_keeps_means(void **state)
{
    (void)state;
    const struct relume_light light = {.direction = {0, 0, 1}, .rgb = {1, 1, 1}};
    double error[2] = {0.0, 0.0};
    write_wall();
    for (int dither = 0; dither < 2; dither++) {
        encode_wall((float)dither);
        relume_pack *pack = open_pack(path);
        const struct relume_codes *codes;
        struct relume_image image = {0};
        CHECK_OK(relume_pack_codes(&codes, pack, 0));
        CHECK_OK(relume_relight(&image, codes, &light, 1, NULL));
        int areas = 0;
        for (int y = 2 * AREA; y < SIDE - 2 * AREA; y += AREA)
            for (int x = 2 * AREA; x < SIDE - 2 * AREA; x += AREA) {
                double mean = 0.0;
                if (fabs(wall(y * SIDE + x) - 0.5) > 0.2)
                    continue;  // beyond the outermost code there is no neighbour
                for (int i = 0; i < AREA * AREA; i++) {
                    const int p = (y + i / AREA) * SIDE + x + i % AREA;
                    mean += ((double)image.data[3 * p] - wall(p)) / (AREA * AREA);
                }
                error[dither] += mean * mean;
                areas++;
            }
        error[dither] = sqrt(error[dither] / areas);
        relume_image_destroy(&image);
        relume_pack_destroy(&pack);
    }
    print_message("  errors of areas: %g, with dither %g\n", error[0], error[1]);
    assert_true(error[0] > 0.005);
    assert_true(error[1] < 0.4 * error[0]);
}

static relume_status encode_once(void)
{
    return fixture_encode(
        folder, path, &relume_basis_sh, 4,
        relume_pack_encode_params(.threads = 1,
                                  .books =
                                      relume_books_params(.codes = 5, .split = RELUME_SPLIT_LUMA,
                                                          .dither = 0.5f, .max_rounds = 2)));
}

static relume_status read_once(void)
{
    relume_pack *pack;
    const struct relume_codes *codes;
    relume_status status = relume_pack_open(&pack, path, relume_pack_params(.threads = 1));
    if (!status)
        status = relume_pack_codes(&codes, pack, 0);
    relume_pack_destroy(&pack);
    return status;
}

static void test_allocations(void **state)
{
    (void)state;
    relume_status (*const work[])(void) = {encode_once, read_once};
    fixture_write(&(struct fixture){.width = 5, .height = 4, .lights = 6, .views = 1}, folder);
    for (int w = 0; w < 2; w++)
        for (int n = 1;; n++) {
            mem_fail_after(n);
            const relume_status status = work[w]();
            const bool done = mem_fail_pending();
            mem_fail_after(0);
            if (done) {
                CHECK_OK(status);
                break;
            }
            assert_int_equal(status, RELUME_ENOMEM);
            assert_true(n < 5000);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_forms),       cmocka_unit_test(test_more_is_better),
        cmocka_unit_test(test_report),      cmocka_unit_test(test_share),
        cmocka_unit_test(test_other_bases), cmocka_unit_test(test_bad_params),
        cmocka_unit_test(test_threads),     cmocka_unit_test(test_dither_keeps_means),
        cmocka_unit_test(test_allocations),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
