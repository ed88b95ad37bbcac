// test_status.c - every status by the public functions: each kind of fault has its own
#include "test.h"

#include "capture_fixture.h"
#include "core/base/memory.h"

#include <sys/resource.h>

static char folder[64];
static struct relume_buffer pack;  // a relume file
static unsigned char *version;     // in it: the format's, little-endian

static int setup(void **state)
{
    (void)state;
    const struct fixture f = {.width = 5, .height = 20, .lights = 6, .views = 1};
    const struct relume_writer writer = relume_buffer_writer(&pack);
    static const char attribute[] = "relume.version\0int\0\4\0\0";
    test_folder(folder);
    fixture_write(&f, folder);
    if (fixture_encode(folder, NULL, &relume_basis_sh, 4,
                       relume_pack_encode_params(.writer = &writer)))
        return 1;
    version = memmem(pack.data, pack.size, attribute, sizeof attribute);
    version = version ? version + sizeof attribute : NULL;
    return !version;
}

static int teardown(void **state)
{
    (void)state;
    relume_buffer_destroy(&pack);
    test_folder_remove(folder);
    return 0;
}

static relume_status open_bytes(const void *bytes, size_t size, const struct relume_limits *limits)
{
    const struct relume_reader reader = relume_memory_reader(bytes, size);
    relume_pack *p;
    const relume_status status =
        relume_pack_open(&p, "memory", relume_pack_params(.reader = &reader, .limits = limits));
    assert_int_equal(status == RELUME_OK, p != NULL);
    relume_pack_destroy(&p);
    return status;
}

static relume_status open_file(const char *path)
{
    relume_pack *p;
    const relume_status status = relume_pack_open(&p, path, NULL);
    relume_pack_destroy(&p);
    return status;
}

static void test_what_is_wrong_with_a_file(void **state)
{
    (void)state;
    static const char picture[] = "\x89PNG\r\n\x1a\n";
    CHECK_OK(open_bytes(pack.data, pack.size, NULL));
    assert_int_equal(open_file("/nowhere/at/all.exr"), RELUME_ENOTFOUND);
    assert_int_equal(open_file(folder), RELUME_EFORMAT);
    assert_int_equal(open_bytes(picture, sizeof picture, NULL), RELUME_EFORMAT);
    assert_int_equal(open_bytes(pack.data, pack.size - 9, NULL), RELUME_EDAMAGED);
    assert_int_equal(open_bytes(pack.data, pack.size, &(struct relume_limits){.max_side = 19}),
                     RELUME_ELIMIT);
    version[0] += 100;
    assert_int_equal(open_bytes(pack.data, pack.size, NULL), RELUME_EUNSUPPORTED);
    version[0] -= 100;
}

// The same for what other programs wrote.
static void test_other_formats(void **state)
{
    (void)state;
#define PTM_NUMBERS "1 1 1 1 1 1\n0 0 0 0 0 0\n"
    static const struct {
        const char *name, *text;
        relume_status status;
    } file[] = {
        {"a.rti", "photograph", RELUME_EFORMAT},
        {"b.rti", "2\n4 4 3\n", RELUME_EUNSUPPORTED},
        {"c.rti", "3\n4 4 4\n9 2 1\n", RELUME_EUNSUPPORTED},
        {"d.rti", "3\n4 4 3\n1 2 1\nAAAA", RELUME_EDAMAGED},
        {"e.rti", "3\n4 4 3\n1 2 1\nAAAABBBBcodes", RELUME_EDAMAGED},
        {"f.rti", "3\n4 4 3\n1 2 1\n\xff\xff\xff\xff\xff\xff\xff\xff", RELUME_EDAMAGED},
        {"g.rti", "3\n70000 4 3\n1 2 1\nAAAABBBBcodes", RELUME_ELIMIT},
        {"a.ptm", "photograph", RELUME_EFORMAT},
        {"b.ptm", "PTM_3.0\nPTM_FORMAT_RGB\n4\n4\n" PTM_NUMBERS, RELUME_EUNSUPPORTED},
        {"c.ptm", "PTM_1.2\nPTM_FORMAT_LUM\n4\n4\n" PTM_NUMBERS, RELUME_EUNSUPPORTED},
        {"d.ptm", "PTM_1.2\nPTM_FORMAT_RGB\n4\n4\n" PTM_NUMBERS "codes", RELUME_EDAMAGED},
        {"e.ptm", "PTM_1.2\nPTM_FORMAT_RGB\n70000\n4\n" PTM_NUMBERS "codes", RELUME_ELIMIT},
        {"info.json", "{\"type\":\"ptm\",", RELUME_EFORMAT},
        {"info.json", "{\"type\":\"neural\",\"colorspace\":\"rgb\"}", RELUME_EUNSUPPORTED},
        {"info.json", "{\"type\":\"ptm\",\"colorspace\":\"lab\"}", RELUME_EUNSUPPORTED},
        {"info.json", "{\"type\":\"ptm\",\"colorspace\":\"lrgb\",\"nplanes\":9}", RELUME_EFORMAT},
    };
    for (size_t i = 0; i < sizeof file / sizeof *file; i++) {
        char path[128], out[128];
        snprintf(path, sizeof path, "%s/%s", folder, file[i].name);
        snprintf(out, sizeof out, "%s/out.exr", folder);
        test_write(path, file[i].text, strlen(file[i].text));
        const relume_status status = relume_import(path, out, NULL);
        if (status != file[i].status)
            fail_msg("%s (%zu): %s; expected %s", file[i].name, i, relume_status_name(status),
                     relume_status_name(file[i].status));
    }
}

static void test_what_does_not_do_here(void **state)
{
    (void)state;
    const struct relume_vec3 light[] = {{0, 0, 1}, {0, 0.6, 0.8}};
    relume_coder *coder;
    assert_int_equal(relume_coder_create(&coder, &relume_basis_sh, light, 2,
                                         relume_coder_params(.coefficients = 9)),
                     RELUME_EUNFIT);
    assert_int_equal(relume_coder_create(&coder, &relume_basis_sh, light, 2,
                                         relume_coder_params(.coefficients = 5)),
                     RELUME_EINVAL);
}

static bool stop(void *user, const char *what, double done)
{
    (void)user, (void)what, (void)done;
    return false;
}

static void test_what_the_machine_lacks(void **state)
{
    (void)state;
    struct rlimit files, none;
    const struct relume_log log = {.progress = stop};
    struct relume_buffer out = {0};
    const struct relume_writer writer = relume_buffer_writer(&out);
    assert_int_equal(relume_file_save("/nowhere/at/all", "x", 1, NULL), RELUME_EIO);
    mem_fail_after(1);
    assert_int_equal(open_bytes(pack.data, pack.size, NULL), RELUME_ENOMEM);
    mem_fail_after(0);
    assert_false(getrlimit(RLIMIT_NOFILE, &files));
    none = (struct rlimit){0, files.rlim_max};
    assert_false(setrlimit(RLIMIT_NOFILE, &none));
    const relume_status status = open_file("/etc/passwd");
    assert_false(setrlimit(RLIMIT_NOFILE, &files));
    assert_int_equal(status, RELUME_ESYSTEM);
    assert_int_equal(fixture_encode(folder, NULL, &relume_basis_sh, 4,
                                    relume_pack_encode_params(.writer = &writer, .log = &log)),
                     RELUME_ECANCEL);
    relume_buffer_destroy(&out);
}

static void test_the_table(void **state)
{
    (void)state;
    static const struct {
        relume_status status;
        int exit;
        const char *name;
    } want[] = {
        {RELUME_OK, 0, "ok"},
        {RELUME_ENOTFOUND, 1, "not-found"},
        {RELUME_EFORMAT, 1, "format"},
        {RELUME_EDAMAGED, 1, "damaged"},
        {RELUME_ELIMIT, 1, "limit"},
        {RELUME_EUNSUPPORTED, 1, "unsupported"},
        {RELUME_EUNFIT, 1, "unfit"},
        {RELUME_EINVAL, 2, "usage"},
        {RELUME_ENOMEM, 3, "memory"},
        {RELUME_EIO, 3, "output"},
        {RELUME_ESYSTEM, 3, "system"},
        {RELUME_ECANCEL, 130, "cancelled"},
        {RELUME_ECODER, 3, "coder"},
        {(relume_status)(RELUME_ECODER + 1), 3, "unknown"},
        {(relume_status)-1, 3, "unknown"},
    };
    for (size_t i = 0; i < sizeof want / sizeof *want; i++) {
        assert_int_equal(relume_status_exit(want[i].status), want[i].exit);
        assert_string_equal(relume_status_name(want[i].status), want[i].name);
        assert_int_equal(relume_status_is_input(want[i].status), want[i].exit == 1);
        assert_true(strlen(relume_status_text(want[i].status)) > 7);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_wrong_with_a_file),
        cmocka_unit_test(test_other_formats),
        cmocka_unit_test(test_what_does_not_do_here),
        cmocka_unit_test(test_what_the_machine_lacks),
        cmocka_unit_test(test_the_table),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
