// test_pack.c - a relume file, written and read: everything that went in comes out
#include "test.h"

#include "capture_fixture.h"
#include "core/base/half.h"
#include "format/coder/coding.h"
#include "format/pack/format.h"
#include "format/pack/pack_write.h"
#include "image/image/exr.h"
#include "relight/light/refit.h"
#include "pack_in_folder.h"
#include "pack_parts.h"

static void check_planes(relume_pack *pack, const struct fixture *f, int view)
{
    struct relume_image depth, mask;
    CHECK_OK(relume_pack_depth(&depth, pack, view));
    CHECK_OK(relume_pack_mask(&mask, pack, view));
    assert_true((depth.data != NULL) == f->depth && (mask.data != NULL) == f->mask);
    for (int i = 0; depth.data && i < f->width * f->height; i++)
        assert_true(depth.data[i] == (i % 3 ? 2.5f : INFINITY));
    for (int i = 0; mask.data && i < f->width * f->height; i++)
        assert_true(mask.data[i] == (i % 5 > 0));
    relume_image_destroy(&depth);
    relume_image_destroy(&mask);
}

// The table keeps the captured samples: at a captured light the value is that of the fixture, half
// a step away at most.
static void check_values(relume_pack *pack, const struct fixture *f, int view)
{
    const struct relume_codes *codes;
    CHECK_OK(relume_pack_codes(&codes, pack, view));
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    for (int i = 0; i < f->lights; i++) {
        const struct relume_light light = {.direction = info->directions[i], .rgb = {1, 1, 1}};
        struct relume_image image = {0};
        CHECK_OK(relume_relight(&image, codes, &light, 1, NULL));
        for (int p = 0; p < f->width * f->height; p++)
            for (int c = 0; c < 3; c++) {
                const bool inside = !f->mask || p % 5 > 0;
                const double want =
                    inside ? fixture_value(f, view, light.direction, p % f->width, p / f->width, c)
                           : 0.0;
                const double step = codes->storage == RELUME_STORE_FLOAT ? 0.0
                                    : codes->storage == RELUME_STORE_HALF
                                        ? 0x1p-10 * (want + 0x1p-14)  // 11 bits, half a step
                                        : (double)codes->scale[3 * i + c];
                // with a mask 0 must be a code, which may move the others by half a step
                // the scratch file's 16 bits a band, and directions in single precision
                CHECK_NEAR(image.data[3 * p + c], want, step * (f->mask ? 1.01 : 0.51) + 2e-5);
            }
        double rgb[3];
        relume_relight_pixel(rgb, codes, f->width - 1, 0, &light, 1);
        CHECK_NEAR(image.data[3 * (f->width - 1)], rgb[0], 1e-6);
        relume_image_destroy(&image);
    }
}

static void test_round_trips(void **state)
{
    (void)state;
    static const char *const names[] = {"", "none", "rle", "zip", "piz"};
    const struct fixture fixtures[] = {
        {.width = 11, .height = 37, .lights = 7, .views = 1, .hemisphere = true},
        {.width = 8, .height = 5, .lights = 9, .views = 3, .depth = true, .mask = true},
        {.width = 1, .height = 1, .lights = 1, .views = 1, .depth = true},
    };
    for (size_t i = 0; i < sizeof fixtures / sizeof *fixtures; i++) {
        const struct fixture *f = &fixtures[i];
        fixture_write(f, folder);
        for (int storage = RELUME_STORE_8; storage <= RELUME_STORE_FLOAT; storage++)
            for (int c = RELUME_COMPRESS_NONE; c <= RELUME_COMPRESS_PIZ; c++) {
                relume_pack *pack;
                CHECK_OK(fixture_encode(
                    folder, path, &relume_basis_table, 0,
                    relume_pack_encode_params(.storage = (enum relume_storage)storage,
                                              .compression = (enum relume_compression)c)));
                CHECK_OK(relume_pack_open(&pack, path, NULL));
                const struct relume_pack_info *info = relume_pack_info(pack);
                assert_int_equal(info->version, 1);
                assert_int_equal(info->width, f->width);
                assert_int_equal(info->height, f->height);
                assert_int_equal(info->views, f->views);
                assert_int_equal(info->storage, storage);
                assert_string_equal(info->compression, names[c]);
                assert_int_equal(info->domain, RELUME_DOMAIN_LINEAR);
                assert_true(info->has_depth == f->depth && info->has_mask == f->mask);
                assert_int_equal(info->geometry.projection,
                                 f->views > 1 ? RELUME_SLAB : RELUME_PLANAR);
                assert_int_equal(relume_coder_info(info->coder)->hemispherical, f->hemisphere);
                for (int v = 0; v < f->views; v++) {
                    if (f->views > 1)
                        CHECK_NEAR(info->uv[v][0], v, 0.0);
                    check_planes(pack, f, v);
                    check_values(pack, f, v);
                    check_parts(pack, v);
                    relume_pack_drop(pack, v);
                }
                const struct relume_codes *codes;
                assert_int_equal(relume_pack_codes(&codes, pack, f->views), RELUME_EINVAL);
                assert_int_equal(relume_pack_codes(&codes, pack, -1), RELUME_EINVAL);
                assert_null(codes);
                relume_pack_destroy(&pack);
            }
    }
}

// The first part: halves [row][B, G, R][x].
static void keep_rows(void *context, const struct relume_rect *at, const void *samples)
{
    struct relume_image *image = context;
    const int row = at->top, rows = at->height;
    const size_t width = (size_t)image->width;
    const uint16_t *halves = samples;
    for (size_t i = 0; i < (size_t)rows * 3 * width; i++)
        image->data[3 * ((size_t)row * width + i / (3 * width) * width + i % width) +
                    (2 - i / width % 3)] = float_from_half(halves[i]);
}

static void read_preview(struct relume_image *out)
{
    exr_file *file;
    CHECK_OK(exr_open(&file, path, NULL, NULL, NULL));
    const struct exr_part_info info = exr_part_info(file, 0);
    assert_string_equal(info.name, "preview");
    CHECK_OK(relume_image_create(out, info.width, info.height, 3));
    CHECK_OK(exr_read(file, 0, NULL, 1, keep_rows, out, NULL));
    exr_close(&file);
}

// What the preview must show: the file's own middle view from the front, but for its mask.
static void check_preview(enum relume_domain domain, const struct relume_books_params *books,
                          enum relume_compression compression)
{
    struct relume_image want = {0}, found;
    const struct relume_codes *codes;
    relume_pack *pack;
    CHECK_OK(fixture_encode(folder, path, &relume_basis_pca, 4,
                            relume_pack_encode_params(.domain = domain, .books = books,
                                                      .compression = compression, .threads = 3)));
    CHECK_OK(relume_pack_open(&pack, path, NULL));
    CHECK_OK(relume_pack_codes(&codes, pack, relume_pack_info(pack)->views / 2));
    const struct relume_light light = {.direction = {0, 0, 1}, .rgb = {1, 1, 1}};
    CHECK_OK(relume_relight(&want, codes, &light, 1, NULL));
    read_preview(&found);
    for (int i = 0; i < 3 * want.width * want.height; i++)
        // half floats: 2^-11 relative, 2^-25 below 2^-14; kernels round their sums differently
        CHECK_NEAR(found.data[i], want.data[i], 0x1p-11 * fabs((double)want.data[i]) + 2e-6);
    relume_image_destroy(&want);
    relume_image_destroy(&found);
    relume_pack_destroy(&pack);
}

static void test_preview(void **state)
{
    (void)state;
    static const struct relume_books_params books = {
        .struct_size = sizeof books, .codes = 16, .stages = 2};
    fixture_write(
        &(struct fixture){.width = 9, .height = 67, .lights = 9, .views = 3, .mask = true}, folder);
    for (int c = RELUME_COMPRESS_NONE; c <= RELUME_COMPRESS_PIZ; c += 3)
        for (int domain = RELUME_DOMAIN_LINEAR; domain <= RELUME_DOMAIN_DISPLAY; domain++) {
            check_preview((enum relume_domain)domain, NULL, (enum relume_compression)c);
            check_preview((enum relume_domain)domain, &books, (enum relume_compression)c);
        }
}

// With loss five bits of each value are left out, rounded: 2^-6 of it, beside the file's own error.
static void test_small_preview(void **state)
{
    (void)state;
    struct relume_image want = {0}, found;
    const struct relume_codes *codes;
    const struct relume_light light = {.direction = {0, 0, 1}, .rgb = {1, 1, 1}};
    relume_pack *pack;
    fixture_write(&(struct fixture){.width = 24, .height = 20, .lights = 9, .views = 1}, folder);
    CHECK_OK(fixture_encode(folder, path, &relume_basis_pca, 4,
                            relume_pack_encode_params(.psnr_db = 45.0)));
    CHECK_OK(relume_pack_open(&pack, path, NULL));
    CHECK_OK(relume_pack_codes(&codes, pack, 0));
    CHECK_OK(relume_relight(&want, codes, &light, 1, NULL));
    read_preview(&found);
    for (int i = 0; i < 3 * want.width * want.height; i++) {
        assert_int_equal(half_from_float(found.data[i]) & 0x1f, 0);
        CHECK_NEAR(found.data[i], want.data[i], 0x1p-6 * fabs((double)want.data[i]) + 0.05);
    }
    relume_image_destroy(&want);
    relume_image_destroy(&found);
    relume_pack_destroy(&pack);
}

static relume_status stripes(void *user, int row, int rows, float *rgb)
{
    const int width = *(const int *)user;
    for (int i = 0; i < 3 * rows * width; i++)
        rgb[i] = i % 3 == 1 ? 1e6f : (float)(row + i / (3 * width));  // half floats end at 65504
    return row < 64 ? RELUME_OK : RELUME_ESYSTEM;
}

// Any picture can be handed in; none is black; what fails there ends the writing.
static void test_own_preview(void **state)
{
    (void)state;
    relume_coder *coder;
    relume_coefficients *coefficients;
    const struct relume_vec3 front = {0, 0, 1};
    int width = 2;
    for (int height = 40; height <= 70; height += 30) {
        const void *const planes[3] = {(char[140]){0}, (char[140]){0}, (char[140]){0}};
        CHECK_OK(relume_coder_create(&coder, &relume_basis_table, &front, 1, NULL));
        const struct relume_codes codes = {.coder = coder,
                                           .width = width,
                                           .height = height,
                                           .planes = 3,
                                           .storage = RELUME_STORE_8,
                                           .plane = planes,
                                           .scale = (float[]){1, 1, 1},
                                           .offset = (float[]){0, 0, 0}};
        CHECK_OK(relume_coefficients_keep(&coefficients, &codes,
                                          relume_project_params(.scratch = path)));
        const struct relume_pack_view view = {.coefficients = coefficients};
        struct relume_pack_contents contents = {
            .coder = coder,
            .domain = RELUME_DOMAIN_LINEAR,
            .display = {.curve = RELUME_CURVE_SRGB},
            .geometry = relume_geometry_default(RELUME_PLANAR, width, height),
            .views = 1,
            .view = &view,
        };
        struct relume_image found;
        CHECK_OK(relume_pack_write(&contents, path, NULL));
        read_preview(&found);
        for (int i = 0; i < 3 * width * height; i++)
            assert_true(found.data[i] == 0.0f);
        relume_image_destroy(&found);
        contents.preview = stripes;
        contents.preview_user = &width;
        const relume_status status = relume_pack_write(&contents, path, NULL);
        assert_int_equal(status, height > 64 ? RELUME_ESYSTEM : RELUME_OK);
        if (!status) {
            read_preview(&found);
            for (int i = 0; i < 3 * width * height; i++)
                assert_true(found.data[i] == (i % 3 == 1 ? 65504.0f : (float)(i / (3 * width))));
            relume_image_destroy(&found);
        }
        relume_coefficients_destroy(&coefficients);
        relume_coder_destroy(&coder);
    }
}

static void test_limits(void **state)
{
    (void)state;
    fixture_write(&(struct fixture){.width = 8, .height = 5, .lights = 9, .views = 3}, folder);
    CHECK_OK(fixture_encode(folder, path, &relume_basis_sh, 4, NULL));
    const struct relume_limits limits[] = {
        {.max_side = 7}, {.max_pixels = 39}, {.max_lights = 8}, {.max_views = 2}};
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        relume_pack *pack = (void *)1;
        struct test_log log;
        test_log_init(&log);
        assert_true(relume_status_is_input(relume_pack_open(
            &pack, path, relume_pack_params(.limits = &limits[i], .log = &log.log))));
        assert_null(pack);
        assert_int_equal(log.lines, 1);
        assert_non_null(strstr(log.text, path));
    }
}

static bool stop(void *user, const char *what, double done)
{
    int *left = user;
    (void)what, (void)done;
    return (*left)-- > 0;
}

static void test_cancel(void **state)
{
    (void)state;
    fixture_write(&(struct fixture){.width = 8, .height = 50, .lights = 4, .views = 2}, folder);
    for (int after = 0; after < 100; after++) {
        int left = after;
        const struct relume_log log = {.progress = stop, .user = &left};
        unlink(path);
        const relume_status status = fixture_encode(folder, path, &relume_basis_sh, 4,
                                                    relume_pack_encode_params(.log = &log));
        assert_true((access(path, F_OK) == 0) == (status == RELUME_OK));
        if (!status) {
            assert_true(after >= 6);  // some bands, some parts
            return;
        }
        assert_int_equal(status, RELUME_ECANCEL);
    }
    fail_msg("never done");
}

struct bar {
    double least, most;
};

static bool note(void *user, const char *what, double done)
{
    struct bar *bar = user;
    if (!strcmp(what, "encoding")) {
        bar->least = fmin(bar->least, done);
        bar->most = fmax(bar->most, done);
    }
    return true;
}

// Parts of whole views, and of rows of one: each bar goes from the first band to all of the part.
static void test_progress_of_parts(void **state)
{
    (void)state;
    for (int views = 1; views <= 4; views += 3) {
        fixture_write(&(struct fixture){.width = 8, .height = 64, .lights = 4, .views = views},
                      folder);
        for (int part = 1; part <= 2; part++) {
            struct bar bar = {2.0, -1.0};
            const struct relume_log log = {.progress = note, .user = &bar};
            unlink(path);
            CHECK_OK(
                fixture_encode(folder, path, &relume_basis_sh, 4,
                               relume_pack_encode_params(.log = &log, .part = part, .parts = 2)));
            CHECK_NEAR(bar.least, views == 1 ? 0.5 : 0.125, 1e-9);  // 1 band of 2, of 8
            CHECK_NEAR(bar.most, 1.0, 1e-9);
        }
    }
    unlink(path);
}

// How far the next camera of a slab sees a pixel moved, in pixels, by a wrong depth along its ray.
static double parallax(const relume_pack *pack, int view, int pixel, double truth, double found)
{
    const struct relume_pack_info *info = relume_pack_info(pack);
    const struct relume_geometry *g = relume_pack_geometry(pack, view);
    const double size[2] = {(g->st_max[0] - g->st_min[0]) / info->width,
                            (g->st_max[1] - g->st_min[1]) / info->height};
    const double s = g->st_min[0] + (pixel % info->width + 0.5) * size[0] - info->uv[view][0];
    const double t = g->st_max[1] - (pixel / info->width + 0.5) * size[1] - info->uv[view][1];
    const double ahead = fabs(g->uv_z - g->st_z), whole = sqrt(s * s + t * t + ahead * ahead);
    const double between = (info->views - 1) / (sqrt(info->views) - 1.0);
    return fabs(1.0 / truth - 1.0 / found) * whole * between / fmin(size[0], size[1]);
}

// Coded depth: half a pixel at most, rounding and smoothing together, or 1/64 of the usual; twice
// that where planes are coarse.
static void check_coded_depth(int views, double psnr_db, double coarser)
{
    const struct fixture f = {.width = 16, .height = 9, .lights = 3, .views = views, .depth = true};
    relume_pack *pack;
    fixture_write(&f, folder);
    CHECK_OK(fixture_encode(folder, path, &relume_basis_table, 0,
                            relume_pack_encode_params(.psnr_db = psnr_db)));
    CHECK_OK(relume_pack_open(&pack, path, NULL));
    for (int v = 0; v < views; v++) {
        struct relume_image depth;
        CHECK_OK(relume_pack_depth(&depth, pack, v));
        for (int i = 0; i < f.width * f.height; i++) {
            const double found = (double)depth.data[i];
            assert_true(isinf(found) == !(i % 3));
            if (i % 3 && views > 1)
                CHECK_NEAR(parallax(pack, v, i, 2.5, found), 0.0, 0.5 * coarser);
            else if (i % 3)
                CHECK_NEAR(found, 2.5, 2.5 / 64 * coarser);
        }
        relume_image_destroy(&depth);
    }
    relume_pack_destroy(&pack);
}

static void test_coded_depth(void **state)
{
    (void)state;
    check_coded_depth(1, 40.0, 1.0);
    check_coded_depth(3, 40.0, 1.0);
    check_coded_depth(3, 20.0, 2.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trips),
        cmocka_unit_test(test_preview),
        cmocka_unit_test(test_small_preview),
        cmocka_unit_test(test_own_preview),
        cmocka_unit_test(test_limits),
        cmocka_unit_test(test_cancel),
        cmocka_unit_test(test_progress_of_parts),
        cmocka_unit_test(test_coded_depth),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
