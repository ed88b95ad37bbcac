// test_open.c - what a page gets of a file that is dropped onto it: the numbers of the file, at
// full size and reduced
#include "test.h"

#include "../../web/open/open.c"

#include "capture_fixture.h"
#include "pack_in_folder.h"

static struct {
    const uint8_t *bytes;
    size_t size;
} file;

int page_read(void *bytes, double offset, int size)
{
    const bool good = offset + size <= (double)file.size;
    if (good)
        memcpy(bytes, file.bytes + (size_t)offset, (size_t)size);
    return good;
}

static struct opened *open_made(char *name)
{
    struct opened *o = open_file(name, (double)file.size);
    assert_non_null(o);
    return o;
}

// Number `n` of pixel `at` of a tile, as the page's shader has it.
static double shown(const struct opened *o, const void *tile, size_t pixels, int n, size_t at)
{
    const size_t i = 4 * ((size_t)(n / 3) * pixels + at) + (size_t)(n % 3);
    const double code = o->bytes ? ((const uint8_t *)tile)[i]
                                 : 255.0 * float_from_half(((const uint16_t *)tile)[i]);
    return code * (double)o->file.levels.scale[n] + (double)o->file.levels.offset[n];
}

// The mean over the pixels that one of a level covers.
static double covered(const float *plane, int width, int height, int step, int x, int y)
{
    double sum = 0.0;
    int count = 0;
    for (int row = y * step; row < (y + 1) * step && row < height; row++)
        for (int column = x * step; column < (x + 1) * step && column < width; column++, count++)
            sum += (double)plane[row * width + column];
    return sum / count;
}

static void check_level(struct opened *o, const struct relume_codes *codes, int view, int level)
{
    const int step = 1 << level, w = codes->width, h = codes->height;
    const int width = (w + step - 1) / step, height = (h + step - 1) / step;
    const size_t pixels = (size_t)width * (size_t)height;
    float *plane = malloc((size_t)w * (size_t)h * sizeof *plane);
    const void *tile = open_tile(o, view, level, 0, 0);
    assert_non_null(tile);
    for (int n = 0; n < codes->planes; n++) {
        relume_codes_plane(codes, n, 0, (size_t)w * (size_t)h, plane);
        for (size_t at = 0; at < pixels; at++) {
            const double want = covered(plane, w, h, step, (int)at % width, (int)at / width);
            // bytes: the file's own codes, and half a step where they are means; halves: 11 bits
            const double off = o->bytes ? (level ? 0.51 : 0.01) * (double)o->file.levels.scale[n]
                                        : 0x1p-11 * fabs(want) + 1e-7;
            CHECK_NEAR(shown(o, tile, pixels, n, at), want, off);
        }
    }
    free(plane);
}

static void check_file(const struct fixture *f, enum relume_storage storage, bool bytes)
{
    char name[] = "a <name>.exr";
    relume_pack *pack;
    fixture_write(f, folder);
    CHECK_OK(fixture_encode(folder, path, &relume_basis_table, 0,
                            relume_pack_encode_params(.storage = storage)));
    file.bytes = test_read(path, &file.size);
    struct opened *o = open_made(name);
    assert_string_equal(open_why(o), "");
    assert_non_null(strstr(open_json(o), "\"title\": \"a \\u003cname\\u003e.exr\""));
    assert_int_equal(open_is_bytes(o), bytes);
    CHECK_OK(relume_pack_open(&pack, path, NULL));
    for (int view = 0; view < f->views; view++) {
        const struct relume_codes *codes;
        CHECK_OK(relume_pack_codes(&codes, pack, view));
        for (int level = 0; level < o->file.levels.count; level++)
            check_level(o, codes, view, level);
        if (f->depth) {
            const uint8_t *depth = open_picture(o, view, 0);
            assert_non_null(depth);
            assert_int_equal(depth[0] | depth[1], 0);
            CHECK_NEAR(1.0 /
                           (open_range(o)[0] + (256 * depth[4] + depth[5] - 1) * open_range(o)[1]),
                       2.5, 1e-6);
            const uint8_t *mask = open_picture(o, view, 1);
            assert_true(mask[0] == 0 && mask[4] == 255);
        }
    }
    relume_pack_destroy(&pack);
    open_close(o);
    free((void *)file.bytes);
}

static void test_numbers(void **state)
{
    (void)state;
    const struct fixture plain = {.width = 141, .height = 30, .lights = 5, .views = 1};
    const struct fixture slab = {
        .width = 70, .height = 9, .lights = 4, .views = 3, .depth = true, .mask = true};
    check_file(&plain, RELUME_STORE_8, true);
    check_file(&plain, RELUME_STORE_16, false);
    check_file(&plain, RELUME_STORE_FLOAT, false);
    check_file(&slab, RELUME_STORE_8, false);
}

// Whatever is cut off: a sentence, and no tile. What is changed may be a byte that is not read.
static void test_damage(void **state)
{
    (void)state;
    const struct fixture f = {.width = 40, .height = 33, .lights = 4, .views = 1};
    char name[] = "a.exr";
    size_t size;
    fixture_write(&f, folder);
    CHECK_OK(fixture_encode(folder, path, &relume_basis_table, 0, NULL));
    uint8_t *bytes = test_read(path, &size);
    file.bytes = bytes;
    for (size_t i = 0; i < 60; i++) {
        const size_t at = i % 30 * size / 30;
        file.size = i < 30 ? at : size;
        bytes[at] ^= i < 30 ? 0 : 0x55;
        struct opened *o = open_made(name);
        const bool shown = !*open_why(o) && open_tile(o, 0, 0, 0, 0);
        assert_true(shown == !*open_why(o));
        assert_true(!shown || i >= 30);
        open_close(o);
        bytes[at] ^= i < 30 ? 0 : 0x55;
    }
    free(bytes);
}

static void test_too_many_planes(void **state)
{
    (void)state;
    const struct fixture f = {.width = 4, .height = 3, .lights = 65, .views = 1};
    char name[] = "a.exr";
    fixture_write(&f, folder);
    CHECK_OK(fixture_encode(folder, path, &relume_basis_table, 0, NULL));
    file.bytes = test_read(path, &file.size);
    struct opened *o = open_made(name);
    assert_string_equal(open_why(o), "a.exr: 195 planes are too many, expected at most 192; relume "
                                     "publish makes a page of it");
    open_close(o);
    free((void *)file.bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_damage),
        cmocka_unit_test(test_too_many_planes),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
