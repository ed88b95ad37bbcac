// test_pyramid.c - reduced levels of a view: each pixel shows the mean light of 2 x 2 of the level
// before, and any rectangle of a level is what the whole level has there
#include "test.h"

#include "capture_fixture.h"
#include "encode/levels/reduction.h"
#include "format/coder/coding.h"
#include "format/pack/views.h"
#include "image/image/image.h"

static char folder[64], path[96];

static int setup(void **state)
{
    (void)state;
    test_folder(folder);
    snprintf(path, sizeof path, "%s/pyramid.exr", folder);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

static void open_pyramid(relume_pack **pack, const struct relume_basis *basis, int coefficients,
                         enum relume_domain domain, enum relume_storage storage, int threads)
{
    CHECK_OK(fixture_encode(folder, path, basis, coefficients,
                            relume_pack_encode_params(.domain = domain, .storage = storage,
                                                      .pyramid = RELUME_PYRAMID_YES,
                                                      .threads = threads)));
    CHECK_OK(relume_pack_open(pack, path, NULL));
}

static void read_level(struct relume_codes_part *out, relume_pack *pack, int level)
{
    struct relume_rect all = {0};
    relume_pack_level_size(&all.width, &all.height, pack, level);
    CHECK_OK(relume_pack_codes_level(out, pack, 0, level, &all));
}

static void relight_level(struct relume_image *out, relume_pack *pack, int level,
                          struct relume_vec3 direction)
{
    struct relume_codes_part part;
    const struct relume_light light = {.direction = direction, .rgb = {1, 1, 1}};
    read_level(&part, pack, level);
    *out = (struct relume_image){0};
    CHECK_OK(relume_relight(out, &part.codes, &light, 1, NULL));
    relume_codes_part_destroy(&part);
}

// The mean of those of 2 x 2 pixels that there are.
static double mean(const struct relume_image *image, int x, int y, int c)
{
    double sum = 0.0;
    int n = 0;
    for (int i = 0; i < 4; i++) {
        const int u = 2 * x + i % 2, v = 2 * y + i / 2;
        if (u >= image->width || v >= image->height)
            continue;
        sum += (double)image->data[3 * (v * image->width + u) + c];
        n++;
    }
    return sum / n;
}

static void check_means(relume_pack *pack, double tolerance)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const struct relume_coder_info *coder = relume_coder_info(info->coder);
    assert_int_equal(info->levels, 2);  // 301, 151, 76
    for (int light = 0; light < coder->lights; light += TEST_SANITIZED ? 8 : 3)
        for (int level = 1; level <= info->levels; level++) {
            struct relume_image larger, smaller;
            relight_level(&larger, pack, level - 1, coder->directions[light]);
            relight_level(&smaller, pack, level, coder->directions[light]);
            assert_int_equal(smaller.width, (larger.width + 1) / 2);
            assert_int_equal(smaller.height, (larger.height + 1) / 2);
            for (int i = 0; i < smaller.width * smaller.height; i++)
                for (int c = 0; c < 3; c++)
                    CHECK_NEAR(smaller.data[3 * i + c],
                               mean(&larger, i % smaller.width, i / smaller.width, c), tolerance);
            relume_image_destroy(&larger);
            relume_image_destroy(&smaller);
        }
}

static void test_levels_show_means(void **state)
{
    (void)state;
    for (int mask = TEST_SANITIZED; mask < 2; mask++) {
        const struct fixture f = {.width = 203,
                                  .height = 301,
                                  .lights = 8,
                                  .views = 1,
                                  .hemisphere = true,
                                  .mask = mask,
                                  .depth = mask};
        fixture_write(&f, folder);
        const struct {
            const struct relume_basis *basis;
            int coefficients;
            enum relume_domain domain;
            enum relume_storage storage;
            double tolerance;
        } cases[] = {
            // sums in single precision
            {&relume_basis_pca, 5, RELUME_DOMAIN_LINEAR, RELUME_STORE_FLOAT, 1e-5},
            {&relume_basis_hsh, 4, RELUME_DOMAIN_LINEAR, RELUME_STORE_FLOAT, 1e-5},
            // what is fitted to the residual is ridged by 1e-5 of it, and curves are tables
            {&relume_basis_table, 0, RELUME_DOMAIN_DISPLAY, RELUME_STORE_FLOAT, 5e-5},
            {&relume_basis_pca, 24, RELUME_DOMAIN_DISPLAY, RELUME_STORE_FLOAT, 2e-4},
            // half a step of each of 8 planes in both levels, and of the share of the mask
            {&relume_basis_table, 0, RELUME_DOMAIN_LINEAR, RELUME_STORE_8, 0.01},
        };
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
            relume_pack *pack;
            open_pyramid(&pack, cases[i].basis, cases[i].coefficients, cases[i].domain,
                         cases[i].storage, 3);
            check_means(pack, cases[i].tolerance);
            relume_pack_destroy(&pack);
        }
    }
}

static void check_crop(relume_pack *pack, const struct relume_codes *whole, int level,
                       const struct relume_rect *at)
{
    struct relume_codes_part part;
    float got[512], want[512];
    CHECK_OK(relume_pack_codes_level(&part, pack, 0, level, at));
    for (int y = 0; y < at->height; y++)
        for (int p = 0; p < whole->planes; p++) {
            relume_codes_plane(&part.codes, p, (size_t)(y * at->width), (size_t)at->width, got);
            relume_codes_plane(whole, p, (size_t)((at->top + y) * whole->width + at->left),
                               (size_t)at->width, want);
            assert_memory_equal(got, want, sizeof *got * (size_t)at->width);
        }
    relume_codes_part_destroy(&part);
}

static void test_any_rectangle(void **state)
{
    (void)state;
    const struct fixture f = {.width = 301, .height = 203, .lights = 5, .views = 1, .mask = true};
    uint32_t seed = 7;
    relume_pack *pack;
    fixture_write(&f, folder);
    open_pyramid(&pack, &relume_basis_pca, 4, RELUME_DOMAIN_DISPLAY, RELUME_STORE_DEFAULT, 2);
    for (int level = 0; level <= relume_pack_info(pack)->levels; level++) {
        struct relume_codes_part whole;
        read_level(&whole, pack, level);
        const int w = whole.codes.width, h = whole.codes.height;
        for (int i = 0; i < 40; i++) {
            const int left = (int)(test_random(&seed) % (uint32_t)w);
            const int top = (int)(test_random(&seed) % (uint32_t)h);
            const struct relume_rect at = {left, top,
                                           1 + (int)(test_random(&seed) % (uint32_t)(w - left)),
                                           1 + (int)(test_random(&seed) % (uint32_t)(h - top))};
            check_crop(pack, &whole.codes, level, &at);
        }
        const struct relume_rect wrong[] = {{-1, 0, 1, 1}, {0, 0, w + 1, 1}, {0, h, 1, 1}};
        struct relume_codes_part none;
        for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
            assert_int_equal(relume_pack_codes_level(&none, pack, 0, level, &wrong[i]),
                             RELUME_EINVAL);
        assert_int_equal(relume_pack_codes_level(&none, pack, 0, 9, &wrong[2]), RELUME_EINVAL);
        relume_codes_part_destroy(&whole);
    }
    relume_pack_destroy(&pack);
}

// How far a level is from the means of the one before, RMS over all of it and some lights: of
// light, or of display values.
static double level_error(relume_pack *pack, int level, bool shown)
{
    const struct relume_coder_info *coder = relume_coder_info(relume_pack_info(pack)->coder);
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    double sum = 0.0, n = 0.0;
    for (int light = 0; light < coder->lights; light += 3) {
        struct relume_image larger, smaller, *both[] = {&larger, &smaller};
        for (int i = 0; i < 2; i++) {
            relight_level(both[i], pack, level - 1 + i, coder->directions[light]);
            for (int k = 0; shown && k < 3 * both[i]->width * both[i]->height; k++)
                both[i]->data[k] = relume_transfer_encode(srgb, both[i]->data[k]);
        }
        for (int i = 0; i < smaller.width * smaller.height; i++)
            for (int c = 0; c < 3; c++, n++) {
                const double is = (double)smaller.data[3 * i + c];
                const double d = is - mean(&larger, i % smaller.width, i / smaller.width, c);
                sum += d * d;
            }
        relume_image_destroy(&larger);
        relume_image_destroy(&smaller);
    }
    return sqrt(sum / n);
}

static void check_coded(bool linear)
{
    const struct fixture f = {.width = 131,
                              .height = 271,
                              .lights = 6,
                              .views = 1,
                              .hemisphere = true,
                              .mask = linear,
                              .depth = linear};
    relume_pack *pack;
    fixture_write(&f, folder);
    CHECK_OK(fixture_encode(
        folder, path, &relume_basis_pca, 4,
        relume_pack_encode_params(.domain = linear ? RELUME_DOMAIN_LINEAR : RELUME_DOMAIN_DISPLAY,
                                  .psnr_db = 30.0, .pyramid = RELUME_PYRAMID_YES)));
    CHECK_OK(relume_pack_open(&pack, path, NULL));
    assert_string_equal(relume_pack_info(pack)->compression, "av1");
    assert_int_equal(relume_pack_info(pack)->levels, 2);
    // means of codes, to their rounding: 4 planes of 12 bits
    CHECK_NEAR(level_error(pack, 1, !linear), 0.0, 5e-4);
    // what coding it at 30 dB costs, sqrt(0.001)
    CHECK_NEAR(level_error(pack, 2, false), 0.0, 0.032);
    for (int level = 1; level <= 2; level++) {
        struct relume_codes_part whole;
        const struct relume_rect at = {level == 1 ? 61 : 29, level == 1 ? 120 : 7, 4, 11};
        read_level(&whole, pack, level);
        check_crop(pack, &whole.codes, level, &at);
        relume_codes_part_destroy(&whole);
    }
    relume_pack_destroy(&pack);
    CHECK_OK(relume_pack_check(path, NULL));
}

// The first level of coded planes is made of the view, the others are coded too; of both any
// rectangle is what the whole has there.
static void test_coded_levels(void **state)
{
    (void)state;
    check_coded(false);
    check_coded(true);
}

static bool remove_mask(void *user, const char *what, double done)
{
    char mask[96];
    (void)user;
    (void)done;
    snprintf(mask, sizeof mask, "%s/mask.exr", folder);
    if (!strcmp(what, "choosing the step"))
        remove(mask);
    return true;
}

// It was a crash: what could not be read was judged all the same.
static void test_a_mask_that_goes_away(void **state)
{
    (void)state;
    const struct fixture f = {.width = 20, .height = 20, .lights = 4, .views = 1, .mask = true};
    const struct relume_log log = {.progress = remove_mask};
    fixture_write(&f, folder);
    assert_int_equal(fixture_encode(folder, path, &relume_basis_pca, 2,
                                    relume_pack_encode_params(.log = &log, .psnr_db = 35.0)),
                     RELUME_ENOTFOUND);
}

// The same bytes from any number of threads.
static void test_threads(void **state)
{
    (void)state;
    const struct fixture f = {.width = 150, .height = 290, .lights = 5, .views = 1};
    char *bytes[2];
    size_t size[2];
    fixture_write(&f, folder);
    for (int i = 0; i < 2; i++) {
        relume_pack *pack;
        open_pyramid(&pack, &relume_basis_sh, 4, RELUME_DOMAIN_DISPLAY, RELUME_STORE_DEFAULT,
                     i ? 7 : 1);
        relume_pack_destroy(&pack);
        bytes[i] = test_read(path, &size[i]);
    }
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(bytes[0], bytes[1], size[0]);
    free(bytes[0]);
    free(bytes[1]);
}

// Pages of files that the process has in memory.
static long mapped_pages(void)
{
    long size, resident, shared = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    assert_int_equal(f ? fscanf(f, "%ld %ld %ld", &size, &resident, &shared) : 0, 3);
    fclose(f);
    return shared;
}

// Masks of large views, and their shares, lie on disk: no more of them is in memory than is looked
// at, and the shares are the means.
static void test_large_masks_are_not_in_memory(void **state)
{
    (void)state;
    const struct relume_project_params p = {.scratch = path};
    const int width = 4203, height = 4001;
    struct relume_image mask, whole, half;
    CHECK_OK(image_create_large(&mask, width, height, 1, path, NULL));
    assert_int_equal(mask.mapped, sizeof(float) * width * height);
    const long before = mapped_pages();
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++)
            mask.data[y * width + x] = (x * x + y) % 7 > 3 ? 0.6f : 0.5f;
        image_forget(&mask, y, 1);
    }
    CHECK_OK(share_create(&whole, &mask, &p));
    CHECK_OK(share_reduce(&half, &whole, &p));
    // each of the two is 16,000 pages
    assert_in_range(mapped_pages() - before + 1000, 0, 2000);
    for (int i = 0; i < 1000; i++) {
        const int x = i * 2, y = i * 2 % 3999;
        double sum = 0.0;
        for (int k = 0; k < 4; k++)
            sum += ((x + k % 2) * (x + k % 2) + y + k / 2) % 7 > 3;
        CHECK_NEAR(half.data[y / 2 * half.width + x / 2], sum / 4.0, 0.0);
    }
    relume_image_destroy(&mask);
    relume_image_destroy(&whole);
    relume_image_destroy(&half);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_levels_show_means, setup, teardown),
        cmocka_unit_test_setup_teardown(test_any_rectangle, setup, teardown),
        cmocka_unit_test_setup_teardown(test_threads, setup, teardown),
        cmocka_unit_test_setup_teardown(test_coded_levels, setup, teardown),
        cmocka_unit_test_setup_teardown(test_a_mask_that_goes_away, setup, teardown),
        cmocka_unit_test_setup_teardown(test_large_masks_are_not_in_memory, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
