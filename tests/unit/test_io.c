// test_io.c - memory and callbacks in place of files: the same bytes, the same pictures, and what
// happens when a callback fails
#include "test.h"

#include "capture_fixture.h"

#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>

static char folder[64], pack_path[96];
static unsigned char *file;  // of pack_path
static size_t file_size;

static int setup(void **state)
{
    (void)state;
    const struct fixture f = {.width = 9,
                              .height = 40,
                              .lights = 6,
                              .views = 2,
                              .hemisphere = true,
                              .depth = true,
                              .mask = true};
    test_folder(folder);
    fixture_write(&f, folder);
    snprintf(pack_path, sizeof pack_path, "%s/pack.exr", folder);
    if (fixture_encode(folder, pack_path, &relume_basis_sh, 4, NULL))
        return 1;
    file = test_read(pack_path, &file_size);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    free(file);
    test_folder_remove(folder);
    return 0;
}

static const char *path_of(const char *name)
{
    static char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static relume_status encode(const struct relume_writer *writer, const struct relume_log *log)
{
    return fixture_encode(folder, NULL, &relume_basis_sh, 4,
                          relume_pack_encode_params(.writer = writer, .log = log));
}

// ---------------------------------------------------------------- memory

static void test_a_pack_in_memory_is_the_file(void **state)
{
    (void)state;
    struct relume_buffer out = {0};
    const struct relume_writer writer = relume_buffer_writer(&out);
    for (int again = 0; again < 2; again++) {  // a buffer takes one output after the other
        CHECK_OK(encode(&writer, NULL));
        assert_true(out.whole);
        assert_int_equal(out.size, file_size);
        assert_memory_equal(out.data, file, file_size);
    }
    relume_buffer_destroy(&out);
    assert_null(out.data);
}

static void check_frame(relume_pack *pack, const struct relume_image *want)
{
    const struct relume_light light = {.direction = {0, 1, 1}, .rgb = {1, 1, 1}};
    const struct relume_camera camera = {.framing = RELUME_FRAME_EYE, .eye = {0.5, 0, 3}};
    struct relume_image frame;
    CHECK_OK(relume_frame(&frame, pack, &camera, &light, 1, NULL));
    assert_memory_equal(frame.data, want->data,
                        sizeof *want->data * 3 * (size_t)want->width * (size_t)want->height);
    relume_image_destroy(&frame);
}

static void test_a_pack_is_opened_from_memory(void **state)
{
    (void)state;
    const struct relume_light light = {.direction = {0, 1, 1}, .rgb = {1, 1, 1}};
    const struct relume_camera camera = {.framing = RELUME_FRAME_EYE, .eye = {0.5, 0, 3}};
    const struct relume_reader reader = relume_memory_reader(file, file_size);
    struct relume_image want;
    relume_pack *a, *b;
    CHECK_OK(relume_pack_open(&a, pack_path, NULL));
    CHECK_OK(relume_frame(&want, a, &camera, &light, 1, NULL));
    CHECK_OK(relume_pack_open(&b, NULL, relume_pack_params(.reader = &reader)));
    assert_int_equal(relume_pack_info(b)->file_bytes, file_size);
    check_frame(b, &want);
    CHECK_OK(relume_pack_check(NULL, relume_pack_check_params(.reader = &reader)));
    relume_image_destroy(&want);
    relume_pack_destroy(&a);
    relume_pack_destroy(&b);
}

static void test_neither_path_nor_callbacks(void **state)
{
    (void)state;
    struct relume_image image = {0};
    relume_pack *pack = (void *)1;
    assert_int_equal(relume_pack_open(&pack, NULL, NULL), RELUME_EINVAL);
    assert_null(pack);
    assert_int_equal(relume_pack_check(NULL, NULL), RELUME_EINVAL);
    assert_int_equal(encode(NULL, NULL), RELUME_EINVAL);
    assert_int_equal(relume_image_load(&image, NULL, NULL), RELUME_EINVAL);
    CHECK_OK(relume_image_create(&image, 1, 1, 3));
    assert_int_equal(relume_image_save(&image, NULL, NULL), RELUME_EINVAL);
    relume_image_destroy(&image);
}

// Cut anywhere: an error with one sentence that names what was read.
static void test_cut_packs(void **state)
{
    (void)state;
    for (size_t size = 0; size < file_size; size += 1 + file_size / 97) {
        unsigned char *part = malloc(size + 1);  // so that ASan sees what is read beyond
        memcpy(part, file, size);
        part = realloc(part, size ? size : 1);
        const struct relume_reader reader = relume_memory_reader(part, size);
        struct test_log log;
        relume_pack *pack;
        test_log_init(&log);
        assert_true(relume_status_is_input(relume_pack_open(
            &pack, "cut", relume_pack_params(.reader = &reader, .log = &log.log))));
        assert_null(pack);
        assert_int_equal(log.lines, 1);
        assert_memory_equal(log.text, "cut: ", 5);
        free(part);
    }
}

// ---------------------------------------------------------------- callbacks

// Reads from memory, fails from the n-th call on, and notes what the library promises.
struct reading {
    const unsigned char *bytes;
    size_t size;
    int calls, fail_at;
    atomic_int inside, crowd;
};

static bool read_some(void *user, void *bytes, size_t size, uint64_t offset)
{
    struct reading *r = user;
    if (atomic_fetch_add(&r->inside, 1))
        atomic_store(&r->crowd, 1);
    assert_true(size > 0 && offset <= r->size && size <= r->size - offset);
    const bool good = ++r->calls != r->fail_at;
    if (good)
        memcpy(bytes, r->bytes + offset, size);
    else
        errno = EPERM;
    atomic_fetch_sub(&r->inside, 1);
    return good;
}

static relume_status read_all(struct reading *r, const struct relume_log *log)
{
    const struct relume_reader reader = {read_some, r, r->size};
    const struct relume_codes *codes;
    struct relume_image depth = {0};
    relume_pack *pack;
    r->calls = 0;
    relume_status status = relume_pack_open(
        &pack, NULL, relume_pack_params(.reader = &reader, .log = log, .threads = 4));
    for (int v = 0; !status && v < 2; v++)
        status = relume_pack_codes(&codes, pack, v);
    if (!status)
        status = relume_pack_depth(&depth, pack, 1);
    relume_image_destroy(&depth);
    relume_pack_destroy(&pack);
    return status;
}

static void test_readers_that_fail(void **state)
{
    (void)state;
    struct reading r = {.bytes = file, .size = file_size};
    CHECK_OK(read_all(&r, NULL));
    const int calls = r.calls;
    assert_true(calls > 10);
    for (int n = 1; n <= calls; n++) {
        struct test_log log;
        test_log_init(&log);
        r.fail_at = n;
        assert_true(relume_status_is_input(read_all(&r, &log.log)));
        assert_int_equal(log.lines, 1);
        assert_memory_equal(log.text, "memory: ", 8);
    }
    assert_int_equal(r.crowd, 0);  // never two calls at once
}

struct writing {
    int calls, fail_at, error, whole, dropped;
    bool refuse;  // at the end
};

static bool write_some(void *user, const void *bytes, size_t size, uint64_t offset)
{
    struct writing *w = user;
    (void)bytes, (void)size, (void)offset;
    assert_int_equal(w->whole + w->dropped, 0);
    errno = w->error;
    return ++w->calls != w->fail_at;
}

static bool finish(void *user, bool whole)
{
    struct writing *w = user;
    *(whole ? &w->whole : &w->dropped) += 1;
    errno = w->error;
    return !w->refuse;
}

static void test_writers_that_fail(void **state)
{
    (void)state;
    struct writing w = {0};
    struct relume_writer writer = {write_some, finish, &w};
    CHECK_OK(encode(&writer, NULL));
    assert_int_equal(w.whole, 1);
    assert_int_equal(w.dropped, 0);
    const int calls = w.calls;
    for (int n = 1; n <= calls; n++) {
        struct test_log log;
        test_log_init(&log);
        w = (struct writing){.fail_at = n, .error = ENOSPC};
        assert_int_equal(encode(&writer, &log.log), RELUME_EIO);
        assert_string_equal(log.text, "memory: writing failed; No space left on device");
        assert_int_equal(w.whole, 0);
        assert_int_equal(w.dropped, 1);
    }
    w = (struct writing){.fail_at = 3, .error = ENOMEM};
    assert_int_equal(encode(&writer, NULL), RELUME_ENOMEM);
    w = (struct writing){.refuse = true};
    assert_int_equal(encode(&writer, NULL), RELUME_EIO);
    assert_int_equal(w.whole, 1);
    assert_int_equal(w.dropped, 0);
    writer.finish = NULL;
    w = (struct writing){0};
    CHECK_OK(encode(&writer, NULL));
}

// ---------------------------------------------------------------- images

static void fill(struct relume_image *image)
{
    CHECK_OK(relume_image_create(image, 21, 13, 3));
    for (int i = 0; i < 21 * 13 * 3; i++)
        image->data[i] = (float)(0.5 + 0.4 * sin(0.013 * i));
}

// The bytes of a file, the pixels of a file, whoever writes and reads that format.
static void test_images_in_memory(void **state)
{
    (void)state;
    static const char *const names[] = {"a.exr", "a.png", "a.jpg", "a.pfm", "a.hdr", "a.tif"};
    struct relume_image image, a, b;
    fill(&image);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct relume_buffer out = {0};
        const struct relume_writer writer = relume_buffer_writer(&out);
        size_t size;
        CHECK_OK(relume_image_save(&image, path_of(names[i]), NULL));
        CHECK_OK(relume_image_save(&image, names[i], relume_image_params(.writer = &writer)));
        unsigned char *want = test_read(path_of(names[i]), &size);
        assert_int_equal(out.size, size);
        assert_memory_equal(out.data, want, size);
        free(want);

        const struct relume_reader reader = relume_memory_reader(out.data, out.size);
        CHECK_OK(relume_image_load(&a, path_of(names[i]), NULL));
        CHECK_OK(relume_image_load(&b, NULL, relume_image_params(.reader = &reader)));
        assert_int_equal(b.width, 21);
        assert_int_equal(b.height, 13);
        assert_memory_equal(a.data, b.data, sizeof *a.data * 21 * 13 * 3);
        relume_image_destroy(&a);
        relume_image_destroy(&b);
        relume_buffer_destroy(&out);
    }
    relume_image_destroy(&image);
}

static void test_cut_images(void **state)
{
    (void)state;
    static const char *const names[] = {"a.exr", "a.png", "a.jpg", "a.tif"};
    struct relume_image image, got;
    fill(&image);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct relume_buffer out = {0};
        const struct relume_writer writer = relume_buffer_writer(&out);
        CHECK_OK(relume_image_save(&image, names[i], relume_image_params(.writer = &writer)));
        for (int part = 0; part < 5; part++) {
            const struct relume_reader cut =
                relume_memory_reader(out.data, out.size * (size_t)part / 5);
            struct test_log log;
            test_log_init(&log);
            assert_true(relume_status_is_input(relume_image_load(
                &got, NULL, relume_image_params(.reader = &cut, .log = &log.log))));
            assert_null(got.data);
            assert_memory_equal(log.text, "memory: ", 8);
        }
        struct reading r = {.bytes = out.data, .size = out.size, .fail_at = 1};
        const struct relume_reader refused = {read_some, &r, r.size};
        assert_int_equal(relume_image_load(&got, NULL, relume_image_params(.reader = &refused)),
                         RELUME_ENOTFOUND);
        relume_buffer_destroy(&out);
    }
    relume_image_destroy(&image);
}

static void test_formats_by_name(void **state)
{
    (void)state;
    struct writing w = {0};
    const struct relume_writer writer = {write_some, finish, &w};
    struct relume_image image;
    fill(&image);
    assert_int_equal(relume_image_save(&image, "a.xyz", relume_image_params(.writer = &writer)),
                     RELUME_EINVAL);
    assert_int_equal(w.calls + w.whole + w.dropped, 0);
    relume_image_destroy(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_pack_in_memory_is_the_file),
        cmocka_unit_test(test_a_pack_is_opened_from_memory),
        cmocka_unit_test(test_neither_path_nor_callbacks),
        cmocka_unit_test(test_cut_packs),
        cmocka_unit_test(test_readers_that_fail),
        cmocka_unit_test(test_writers_that_fail),
        cmocka_unit_test(test_images_in_memory),
        cmocka_unit_test(test_cut_images),
        cmocka_unit_test(test_formats_by_name),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
