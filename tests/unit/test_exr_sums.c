// test_exr_sums.c - check sums of relume files: no byte changes unseen, of whichever kind the file
// is; files of before have none, and are read as they were
#include "test.h"

#include "capture_fixture.h"
#include "core/base/memory.h"
#include "image/image/exr_sums.h"
#include "pack_in_folder.h"
#include "without_sums.h"

static relume_status check_bytes(const void *bytes, size_t size, bool *has_sums)
{
    const struct relume_reader reader = relume_memory_reader(bytes, size);
    return relume_pack_check(
        NULL, relume_pack_check_params(.reader = &reader, .threads = 1, .has_sums = has_sums));
}

struct seen {
    char part[48];
    int row, rows, count;
};

static void found(void *user, const char *part, int row, int rows)
{
    struct seen *s = user;
    snprintf(s->part, sizeof s->part, "%s", part);
    s->row = row;
    s->rows = rows;
    s->count++;
}

// One bit of every `step`-th byte: fewer under sanitizers, to which what is refused at one byte
// looks as at the next.
enum { STEP = TEST_SANITIZED ? 67 : 17 };
static void check_every_byte(size_t step)
{
    size_t size, unseen = 0;
    unsigned char *file = test_read(path, &size);
    bool has_sums;
    CHECK_OK(check_bytes(file, size, &has_sums));
    assert_true(has_sums);
    for (size_t i = 0; i < size; i += step) {
        file[i] ^= (unsigned char)(1 << i % 8);
        if (!check_bytes(file, size, NULL)) {
            print_error("byte %zu of %zu\n", i, size);
            unseen++;
        }
        file[i] ^= (unsigned char)(1 << i % 8);
    }
    assert_int_equal(unseen, 0);
    CHECK_OK(check_bytes(file, size, NULL));
    free(file);
}

static const struct fixture slab = {
    .width = 8, .height = 40, .lights = 5, .views = 2, .depth = true, .mask = true};

static void encode(const struct fixture *f, const struct relume_basis *basis, int coefficients,
                   const struct relume_pack_encode_params *params)
{
    fixture_write(f, folder);
    CHECK_OK(fixture_encode(folder, path, basis, coefficients, params));
}

static void test_every_byte_of_a_small_file(void **state)
{
    (void)state;
    const struct fixture f = {.width = 6, .height = 5, .lights = 4, .views = 1};
    encode(&f, &relume_basis_sh, 1, relume_pack_encode_params(.no_depth = true));
    check_every_byte(1);
}

static void test_lossless(void **state)
{
    (void)state;
    static const enum relume_compression ways[] = {RELUME_COMPRESS_NONE, RELUME_COMPRESS_RLE,
                                                   RELUME_COMPRESS_ZIP, RELUME_COMPRESS_PIZ};
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        encode(&slab, &relume_basis_sh, 4, relume_pack_encode_params(.compression = ways[i]));
        check_every_byte(STEP);
    }
}

static void test_tiles(void **state)
{
    (void)state;
    const struct fixture f = {.width = 140, .height = 9, .lights = 4, .views = 1, .mask = true};
    encode(&f, &relume_basis_sh, 1, relume_pack_encode_params(.pyramid = RELUME_PYRAMID_YES));
    check_every_byte(STEP);
}

static void test_codebooks(void **state)
{
    (void)state;
    struct relume_books_params books = {.codes = 6};
    encode(&slab, &relume_basis_sh, 4, relume_pack_encode_params(.books = &books));
    check_every_byte(STEP);
}

static void test_planes_with_loss(void **state)
{
    (void)state;
    encode(&slab, &relume_basis_sh, 4, relume_pack_encode_params(.psnr_db = 25.0));
    check_every_byte(STEP + 12);
}

static void test_parts(void **state)
{
    (void)state;
    for (int part = 1; part <= 2; part++) {
        encode(&slab, &relume_basis_sh, 4, relume_pack_encode_params(.part = part, .parts = 2));
        check_every_byte(STEP);
    }
    const struct fixture one = {.width = 6, .height = 40, .lights = 4, .views = 1};
    encode(&one, &relume_basis_sh, 4, relume_pack_encode_params(.part = 2, .parts = 2));
    check_every_byte(STEP);
}

// The place of the byte is named: a block of PIZ has 32 rows.
static void test_where(void **state)
{
    (void)state;
    size_t size, named = 0;
    encode(&slab, &relume_basis_sh, 4, NULL);
    unsigned char *file = test_read(path, &size);
    const struct relume_reader reader = relume_memory_reader(file, size);
    for (size_t i = size / 2; i < size; i += 41) {
        struct seen seen = {.count = 0};
        file[i] ^= 1;
        assert_true(relume_status_is_input(relume_pack_check(
            NULL, relume_pack_check_params(.reader = &reader, .found = found, .user = &seen))));
        assert_int_equal(seen.count, 1);
        if (!strncmp(seen.part, "view", 4)) {
            assert_true(seen.row % 16 == 0 && seen.rows > 0 && seen.row + seen.rows <= 40);
            named++;
        }
        file[i] ^= 1;
    }
    assert_true(named > 10);
    free(file);
}

// The same sums for any number of threads.
static void test_threads(void **state)
{
    (void)state;
    size_t size, other;
    encode(&slab, &relume_basis_sh, 4,
           relume_pack_encode_params(.threads = 1, .compression = RELUME_COMPRESS_NONE));
    unsigned char *one = test_read(path, &size);
    encode(&slab, &relume_basis_sh, 4,
           relume_pack_encode_params(.threads = 7, .compression = RELUME_COMPRESS_NONE));
    unsigned char *seven = test_read(path, &other);
    assert_int_equal(size, other);
    assert_memory_equal(one, seven, size);
    free(one);
    free(seven);
}

static void test_files_of_before(void **state)
{
    (void)state;
    struct relume_buffer old = {0};
    relume_pack *pack;
    bool has_sums;
    encode(&slab, &relume_basis_sh, 4, NULL);
    CHECK_OK(relume_pack_open(&pack, path, NULL));
    assert_true(relume_pack_info(pack)->has_sums);
    relume_pack_destroy(&pack);
    CHECK_OK(without_sums(&old, path));
    CHECK_OK(check_bytes(old.data, old.size, &has_sums));
    assert_false(has_sums);
    const struct relume_reader reader = relume_memory_reader(old.data, old.size);
    const struct relume_codes *codes;
    CHECK_OK(relume_pack_open(&pack, NULL, relume_pack_params(.reader = &reader)));
    assert_false(relume_pack_info(pack)->has_sums);
    CHECK_OK(relume_pack_codes(&codes, pack, 1));
    relume_pack_destroy(&pack);
    relume_buffer_destroy(&old);
}

// A part of before is joined as it was; of a changed one no file is made.
static void test_joined(void **state)
{
    (void)state;
    char name[2][96];
    const char *parts[2] = {name[0], name[1]};
    struct relume_buffer whole = {0}, out = {0}, old = {0};
    const struct relume_writer writer = relume_buffer_writer(&whole);
    const struct relume_writer again = relume_buffer_writer(&out);
    size_t size, unseen = 0;
    bool has_sums;
    encode(&slab, &relume_basis_sh, 4, relume_pack_encode_params(.writer = &writer));
    for (int i = 0; i < 2; i++) {
        encode(&slab, &relume_basis_sh, 4, relume_pack_encode_params(.part = i + 1, .parts = 2));
        snprintf(name[i], sizeof name[i], "%s/%d.part", folder, i);
        assert_int_equal(rename(path, name[i]), 0);
    }
    CHECK_OK(relume_pack_join(parts, 2, NULL, NULL, relume_pack_params(.writer = &again)));
    assert_int_equal(out.size, whole.size);
    assert_memory_equal(out.data, whole.data, whole.size);

    unsigned char *part = test_read(name[0], &size);
    for (size_t i = 5; i < size; i += 143) {
        part[i] ^= 4;
        test_write(name[0], part, size);
        unseen += !relume_pack_join(parts, 2, NULL, NULL, relume_pack_params(.writer = &again));
        part[i] ^= 4;
    }
    assert_int_equal(unseen, 0);
    test_write(name[0], part, size);
    CHECK_OK(without_sums(&old, name[0]));
    test_write(name[0], old.data, old.size);
    CHECK_OK(without_sums(&old, name[1]));
    test_write(name[1], old.data, old.size);
    CHECK_OK(relume_pack_join(parts, 2, NULL, NULL, relume_pack_params(.writer = &again)));
    CHECK_OK(check_bytes(out.data, out.size, &has_sums));
    assert_false(has_sums);  // their header does not promise any
    free(part);
    relume_buffer_destroy(&old);
    relume_buffer_destroy(&out);
    relume_buffer_destroy(&whole);
}

// Many blocks fill several rows of words.
static void test_shape(void **state)
{
    (void)state;
    struct exr_sums s;
    CHECK_OK(exr_sums_create(&s, 3));
    exr_sums_count(&s, 1);
    exr_sums_count(&s, 0);
    exr_sums_count(&s, 5000);
    CHECK_OK(exr_sums_finish(&s));
    assert_int_equal(s.first[2], 2);
    assert_int_equal(s.first[3], 5002);
    assert_int_equal(s.height, 3);
    assert_int_equal(s.width, 1668);
    exr_sums_destroy(&s);
    assert_int_equal(exr_sum(exr_sum(0, "1234", 4), "56789", 5), 0xcbf43926);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_byte_of_a_small_file),
        cmocka_unit_test(test_lossless),
        cmocka_unit_test(test_tiles),
        cmocka_unit_test(test_codebooks),
        cmocka_unit_test(test_planes_with_loss),
        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_where),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_files_of_before),
        cmocka_unit_test(test_joined),
        cmocka_unit_test(test_shape),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
