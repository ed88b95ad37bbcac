// test_io.c - memory and callbacks in place of files: the same bytes, the same pictures, and what
// happens when a callback fails
#include "test.h"

#include "capture_fixture.h"
#include "core/base/params.h"

#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <time.h>

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
    for (int n = 1; n <= calls; n += TEST_SANITIZED ? 1 + calls / 8 : 1) {
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
        // some formats hold the second in which they were written: both in the same one
        time_t before;
        do {
            relume_buffer_destroy(&out);
            before = time(NULL);
            CHECK_OK(relume_image_save(&image, path_of(names[i]), NULL));
            CHECK_OK(relume_image_save(&image, names[i], relume_image_params(.writer = &writer)));
        } while (time(NULL) != before);
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

// ---------------------------------------------------------------- names that are no files

// The folder of a capture, read into memory.
struct store {
    struct entry {
        char path[64];
        unsigned char *bytes;
        size_t size;
    } entry[32];
    int count, open;  // open: given out and not yet given back
};

static bool store_open(void *user, const char *path, struct relume_reader *out)
{
    struct store *s = user;
    for (int i = 0; i < s->count; i++)
        if (!strcmp(s->entry[i].path, path)) {
            *out = relume_memory_reader(s->entry[i].bytes, s->entry[i].size);
            s->open++;
            return true;
        }
    errno = ENOENT;
    return false;
}

static void store_close(void *user, struct relume_reader *reader)
{
    struct store *s = user;
    assert_non_null(reader->read);
    s->open--;
}

static void store_add(struct store *s, const char *name)
{
    struct entry *e = &s->entry[s->count++];
    snprintf(e->path, sizeof e->path, "nowhere/%s", name);
    e->bytes = test_read(path_of(name), &e->size);
    assert_non_null(e->bytes);
}

static relume_context *store_context(struct store *s)
{
    relume_context *context;
    CHECK_OK(relume_context_create(
        &context, relume_context_params(.files = {store_open, store_close, s}, .threads = 2)));
    return context;
}

static void store_free(struct store *s, relume_context *context)
{
    assert_int_equal(s->open, 0);
    relume_context_destroy(&context);
    for (int i = 0; i < s->count; i++)
        free(s->entry[i].bytes);
    free(s);
}

// A capture whose files lie in memory gives the bytes that the folder gives; one that is missing
// there is missed.
static void test_a_capture_of_names(void **state)
{
    (void)state;
    struct store *s = calloc(1, sizeof *s);
    struct relume_buffer out = {0};
    const struct relume_writer writer = relume_buffer_writer(&out);
    struct test_log log;
    relume_capture *capture;
    relume_coder *coder;
    test_log_init(&log);
    log.log.context = store_context(s);
    store_add(s, "capture.json");
    store_add(s, "depth.exr");
    store_add(s, "mask.exr");
    const struct relume_capture_params *how = relume_capture_params(.log = &log.log);
    for (int i = 0; i < 12; i++) {
        char name[32];
        snprintf(name, sizeof name, "v%d-%d.exr", i / 6, i % 6);
        assert_int_equal(relume_capture_open(&capture, "nowhere/capture.json", how),
                         RELUME_ENOTFOUND);
        store_add(s, name);
    }
    CHECK_OK(relume_capture_open(&capture, "nowhere/capture.json", how));
    CHECK_OK(relume_coder_learn(&coder, &relume_basis_sh, capture,
                                relume_coder_params(.coefficients = 4), NULL));
    CHECK_OK(relume_pack_encode(capture, coder, NULL, NULL,
                                relume_pack_encode_params(.writer = &writer)));
    assert_int_equal(out.size, file_size);
    assert_memory_equal(out.data, file, file_size);
    relume_coder_destroy(&coder);
    relume_capture_destroy(&capture);
    relume_buffer_destroy(&out);
    assert_int_equal(relume_capture_open(&capture, path_of("capture.json"), how), RELUME_ENOTFOUND);
    store_free(s, log.log.context);
}

static void compare_frames(relume_pack *a, relume_pack *b)
{
    const struct relume_light light = {.direction = {0, 1, 1}, .rgb = {1, 1, 1}};
    struct relume_image x, y;
    CHECK_OK(relume_frame(&x, a, &(struct relume_camera){0}, &light, 1, NULL));
    CHECK_OK(relume_frame(&y, b, &(struct relume_camera){0}, &light, 1, NULL));
    assert_int_equal(x.width, y.width);
    assert_memory_equal(x.data, y.data, sizeof *x.data * 3 * (size_t)(x.width * x.height));
    relume_image_destroy(&x);
    relume_image_destroy(&y);
    relume_pack_destroy(&a);
    relume_pack_destroy(&b);
}

// What relume_open makes of bytes is what it makes of the file that holds them.
static void check_open(const char *name, const struct relume_buffer *bytes)
{
    const struct relume_reader reader = relume_memory_reader(bytes->data, bytes->size);
    relume_pack *a, *b;
    test_write(path_of(name), bytes->data, bytes->size);
    CHECK_OK(relume_open(&a, path_of(name), NULL));
    CHECK_OK(relume_open(&b, name, relume_open_params(.reader = &reader)));
    compare_frames(a, b);
}

static void test_other_formats_in_memory(void **state)
{
    (void)state;
    const struct relume_reader from = relume_memory_reader(file, file_size);
    const struct relume_image image = {9, 2, 3, .data = (float[54]){1, 2, 3, 4, 5}};
    struct relume_buffer bytes = {0}, again = {0};
    const struct relume_writer writer = relume_buffer_writer(&bytes),
                               other = relume_buffer_writer(&again);
    relume_pack *pack;
    CHECK_OK(relume_open(&pack, NULL, relume_open_params(.reader = &from)));
    CHECK_OK(relume_export(pack, NULL, RELUME_EXCHANGE_RTI, NULL,
                           relume_export_params(.writer = &writer)));
    check_open("a.rti", &bytes);
    CHECK_OK(relume_export(pack, NULL, RELUME_EXCHANGE_LPTM, NULL,
                           relume_export_params(.writer = &writer, .quality = 90)));
    check_open("a.ptm", &bytes);
    assert_int_equal(relume_export(pack, NULL, RELUME_EXCHANGE_RELIGHT, NULL,
                                   relume_export_params(.writer = &writer)),
                     RELUME_EINVAL);
    CHECK_OK(relume_image_save(&image, "a.exr", relume_image_params(.writer = &writer)));
    check_open("a.exr", &bytes);
    CHECK_OK(relume_export(pack, NULL, RELUME_EXCHANGE_PTM, NULL,
                           relume_export_params(.writer = &writer)));
    const struct relume_reader ptm = relume_memory_reader(bytes.data, bytes.size);
    CHECK_OK(relume_import("a.ptm", NULL, relume_import_params(.reader = &ptm, .writer = &other)));
    test_write(path_of("a.ptm"), bytes.data, bytes.size);
    char ptm_path[128];
    snprintf(ptm_path, sizeof ptm_path, "%s", path_of("a.ptm"));
    CHECK_OK(relume_import(ptm_path, path_of("b.exr"), NULL));
    size_t size;
    unsigned char *want = test_read(path_of("b.exr"), &size);
    assert_int_equal(again.size, size);
    assert_memory_equal(again.data, want, size);
    assert_int_equal(relume_import("a.ptm", NULL, NULL), RELUME_EINVAL);
    free(want);
    relume_buffer_destroy(&bytes);
    relume_buffer_destroy(&again);
    relume_pack_destroy(&pack);
}

// What callbacks say of a name counts: it is another's to know, it is none, it cannot be read.
static bool answer_open(void *user, const char *path, struct relume_reader *out)
{
    (void)path, (void)out;
    errno = *(const int *)user;
    return false;
}

static bool fail_read(void *user, void *bytes, size_t size, uint64_t offset)
{
    (void)user, (void)bytes, (void)size, (void)offset;
    errno = EIO;
    return false;
}

static bool unreadable_open(void *user, const char *path, struct relume_reader *out)
{
    (void)user, (void)path;
    *out = (struct relume_reader){fail_read, NULL, 100};
    return true;
}

static void test_names_that_are_not_there(void **state)
{
    (void)state;
    struct test_log log;
    int answer = 0;
    relume_pack *pack;
    relume_capture *capture;
    test_log_init(&log);
    CHECK_OK(relume_context_create(&log.log.context,
                                   relume_context_params(.files = {answer_open, NULL, &answer})));
    CHECK_OK(relume_open(&pack, pack_path, relume_open_params(.log = &log.log)));
    relume_pack_destroy(&pack);
    answer = EACCES;
    assert_int_equal(relume_open(&pack, pack_path, relume_open_params(.log = &log.log)),
                     RELUME_ENOTFOUND);
    assert_null(pack);
    relume_context_destroy(&log.log.context);
    CHECK_OK(relume_context_create(&log.log.context,
                                   relume_context_params(.files = {unreadable_open, NULL, NULL})));
    log.lines = 0;
    assert_int_equal(relume_capture_open(&capture, "a.lp", relume_capture_params(.log = &log.log)),
                     RELUME_ENOTFOUND);
    assert_int_equal(log.lines, 1);
    assert_memory_equal(log.text, "a.lp: ", 6);
    relume_context_destroy(&log.log.context);
}

// A name of the context counts, whatever the disk has of that name: here a folder.
static void test_a_name_that_is_a_folder_too(void **state)
{
    (void)state;
    struct store *s = calloc(1, sizeof *s);
    struct test_log log;
    relume_pack *pack;
    test_log_init(&log);
    store_add(s, strrchr(pack_path, '/') + 1);
    snprintf(s->entry[0].path, sizeof s->entry[0].path, "%s", folder);
    log.log.context = store_context(s);
    CHECK_OK(relume_pack_open(&pack, folder, relume_pack_params(.log = &log.log)));
    relume_pack_destroy(&pack);
    CHECK_OK(relume_open(&pack, folder, relume_open_params(.log = &log.log)));
    relume_pack_destroy(&pack);
    assert_int_equal(relume_pack_open(&pack, folder, NULL), RELUME_EFORMAT);
    store_free(s, log.log.context);
}

static void test_a_web_folder_of_names(void **state)
{
    (void)state;
    struct store *s = calloc(1, sizeof *s);
    const struct relume_log log = {.context = store_context(s)};
    relume_pack *pack, *a, *b;
    CHECK_OK(relume_pack_open(&pack, pack_path, NULL));
    CHECK_OK(relume_export(pack, path_of("web"), RELUME_EXCHANGE_RELIGHT, NULL,
                           relume_export_params(.type = RELUME_WEB_PTM)));
    relume_pack_destroy(&pack);
    store_add(s, "web/info.json");
    for (int i = 0; i < 6; i++) {
        char name[32];
        snprintf(name, sizeof name, "web/plane_%d.jpg", i);
        store_add(s, name);
    }
    CHECK_OK(relume_open(&a, path_of("web"), NULL));
    CHECK_OK(relume_open(&b, "nowhere/web/info.json", relume_open_params(.log = &log)));
    compare_frames(a, b);
    assert_int_equal(relume_open(&b, path_of("web/info.json"), relume_open_params(.log = &log)),
                     RELUME_ENOTFOUND);
    store_free(s, log.context);
}

// ---------------------------------------------------------------- what calls share

static void test_a_context_has_the_defaults(void **state)
{
    (void)state;
    struct relume_log log = {0};
    relume_context *none = NULL;
    struct relume_limits limits = {.max_side = 8};
    CHECK_OK(relume_context_create(&log.context,
                                   relume_context_params(.limits = &limits, .threads = 3)));
    const struct relume_reader reader = relume_memory_reader(file, file_size);
    const struct relume_pack_params *p = relume_pack_params(.log = &log);
    const struct relume_limits enough = {.max_side = 40};
    relume_pack *pack;
    assert_int_equal(PARAMS_WORK(relume_pack_params, p).threads, 3);
    assert_int_equal(
        PARAMS_WORK(relume_pack_params, relume_pack_params(.log = &log, .threads = 2)).threads, 2);
    assert_int_equal(PARAMS_WORK(relume_pack_params, NULL).threads, 0);
    p = relume_pack_params(.log = &log, .reader = &reader);
    assert_int_equal(relume_pack_open(&pack, NULL, p), RELUME_ELIMIT);
    CHECK_OK(relume_pack_open(
        &pack, NULL, relume_pack_params(.log = &log, .reader = &reader, .limits = &enough)));
    relume_pack_destroy(&pack);
    limits = enough;
    CHECK_OK(relume_pack_open(&pack, NULL, p));
    relume_pack_destroy(&pack);
    relume_context_destroy(&log.context);
    assert_null(log.context);
    relume_context_destroy(&none);
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
        cmocka_unit_test(test_a_capture_of_names),
        cmocka_unit_test(test_other_formats_in_memory),
        cmocka_unit_test(test_names_that_are_not_there),
        cmocka_unit_test(test_a_name_that_is_a_folder_too),
        cmocka_unit_test(test_a_web_folder_of_names),
        cmocka_unit_test(test_a_context_has_the_defaults),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
