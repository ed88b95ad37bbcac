// What everything stands on: whole numbers of any value, texts that a terminal shows and does not
// obey
#include "test.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/base64.h"

static void test_whole(void **state)
{
    (void)state;
    const int most = 1 << 30;
    const struct {
        double value;
        int whole;
    } known[] = {
        {0.0, 0},         {-0.9, 0},         {0.9, 0},         {1.0, 1},           {-1.5, -1},
        {65535.7, 65535}, {1e9, 1000000000}, {0x1p30, most},   {0x1p31, most},     {-0x1p31, -most},
        {1e300, most},    {-1e300, -most},   {INFINITY, most}, {-INFINITY, -most}, {NAN, -most},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        assert_int_equal(relume_whole(known[i].value), known[i].whole);
}

static void test_printable(void **state)
{
    (void)state;
    static const struct {
        const char *given, *shown;
    } known[] = {
        {"", ""},
        {"photo 12.jpg", "photo 12.jpg"},
        {"M\xc3\xbcnze \xe6\xbc\xa2 \xf0\x9f\x93\xb7.png",
         "M\xc3\xbcnze \xe6\xbc\xa2 \xf0\x9f\x93\xb7.png"},
        {"a\x1b[31mb\nc\x7f", "a?[31mb?c?"},
        {"a\xc2\x9b"
         "31mb",
         "a?31mb"},  // U+009B begins an escape sequence, too
        {"a\x9b"
         "31mb",
         "a?31mb"},                                           // as it does in Latin-1
        {"gpj.\xe2\x80\xaetxt", "gpj.?txt"},                  // U+202E turns what follows
        {"\xe2\x81\xa6x\xe2\x81\xa9\xe2\x80\xa8y", "?x??y"},  // isolates, a line separator
        {"\xef\xbb\xbfx\xe2\x80\x8by", "?x?y"},               // no width
        {"\xc0\xafx", "??x"},                                 // longer than need be
        {"\xed\xa0\x80x", "???x"},                            // half of a pair
        {"\xf4\x90\x80\x80", "????"},                         // beyond the last
        {"cut \xe6\xbc", "cut ??"},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char text[64];
        snprintf(text, sizeof text, "%s", known[i].given);
        assert_string_equal(relume_printable(text), known[i].shown);
    }
}

static void one_version(void **state)
{
    (void)state;
    char text[32];
    snprintf(text, sizeof text, "%d.%d.%d", RELUME_VERSION_MAJOR, RELUME_VERSION_MINOR,
             RELUME_VERSION_PATCH);
    assert_string_equal(text, RELUME_VERSION);
    assert_int_equal(relume_version(), RELUME_VERSION_NUMBER);
}

// A caller's struct may end sooner or later than ours.
static void params_of_other_versions(void **state)
{
    (void)state;
    struct mine {
        size_t struct_size;
        int a, b;
    };
    const struct theirs {
        size_t struct_size;
        int a, b, later;
    } given = {.a = 3, .b = 4, .later = 5};
    static const struct {
        size_t size;
        int a, b;
    } cases[] = {
        {0, 3, 4},  // filled without the macro
        {offsetof(struct theirs, b), 3, 0},
        {sizeof(struct mine), 3, 4},
        {sizeof(struct theirs), 3, 4},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct theirs params = given;
        params.struct_size = cases[i].size;
        const struct mine own = PARAMS(mine, &params);
        assert_int_equal(own.struct_size, sizeof own);
        assert_int_equal(own.a, cases[i].a);
        assert_int_equal(own.b, cases[i].b);
    }
    const struct mine none = PARAMS(mine, NULL);
    assert_int_equal(none.a + none.b, 0);
}

// Memory doubles, what is there stays, and where memory is short nothing has changed.
static void test_growing_array(void **state)
{
    (void)state;
    int *items = NULL, *before = NULL, failures = 0;
    for (size_t n = 0; n < 1000; n++) {
        before = items;
        mem_fail_after(1);
        if (!mem_grow(&items, n, sizeof *items)) {
            failures++;
            assert_ptr_equal(items, before);
            assert_true(mem_grow(&items, n, sizeof *items));
        }
        mem_fail_after(0);
        items[n] = (int)n;
    }
    assert_int_equal(failures, 7);  // at 0, 16, 32, ... 512
    for (int n = 0; n < 1000; n++)
        assert_int_equal(items[n], n);
    before = items;
    assert_false(mem_grow(&items, (size_t)1 << 62, sizeof *items));
    assert_ptr_equal(items, before);
    relume_free(items);
}

static bool stops(void *user, const char *what, double done)
{
    (void)what, (void)done;
    return user == NULL;
}

// A place stands before what is said there, and all else is that of the log behind.
static void test_places(void **state)
{
    (void)state;
    struct test_log log;
    struct log_place file, region, nowhere;
    relume_context *const context = (void *)&log;
    char name[3000];
    test_log_init(&log);
    log.log.progress = stops;
    log.log.context = context;
    log.log.leave_unnoted = true;
    const struct relume_log *at =
        log_at(&region, log_at(&file, &log.log, "%s: ", "a file"), "region %d: ", 3);
    assert_int_equal(log_fail(at, RELUME_EUNFIT, "expected %s", "more"), RELUME_EUNFIT);
    assert_string_equal(log.text, "a file: region 3: expected more");
    assert_false(log_progress(at, "", 0.5));
    assert_ptr_equal(at->context, context);
    assert_true(at->leave_unnoted);
    at = log_at(&nowhere, NULL, "nowhere");
    assert_int_equal(log_fail(at, RELUME_EIO, "nobody hears it"), RELUME_EIO);
    assert_true(log_progress(at, "", 0.5));
    // a name longer than a line leaves a line
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    assert_int_equal(log_fail(log_at(&file, &log.log, "%s: ", name), RELUME_EIO, "it"), RELUME_EIO);
    assert_int_equal(log.lines, 2);
}

// The vectors of RFC 4648, section 10.
static void test_base64(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {{"", ""},
                                           {"f", "Zg=="},
                                           {"fo", "Zm8="},
                                           {"foo", "Zm9v"},
                                           {"foob", "Zm9vYg=="},
                                           {"fooba", "Zm9vYmE="},
                                           {"foobar", "Zm9vYmFy"}};
    static const char *const none[] = {"Zg=", "Z===", "Zg==Zg==", "Z g=", "====", "Zm9\xe4"};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        char text[16] = "";
        uint8_t bytes[16];
        const size_t n = strlen(pairs[i][0]);
        base64_text(text, (const uint8_t *)pairs[i][0], n);
        assert_string_equal(text, pairs[i][1]);
        assert_int_equal(base64_length(n), strlen(text));
        assert_int_equal(base64_bytes(bytes, text), n);
        assert_memory_equal(bytes, pairs[i][0], n);
    }
    for (size_t i = 0; i < sizeof none / sizeof *none; i++)
        assert_int_equal(base64_bytes((uint8_t[16]){0}, none[i]), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_growing_array),
        cmocka_unit_test(one_version),
        cmocka_unit_test(params_of_other_versions),
        cmocka_unit_test(test_whole),
        cmocka_unit_test(test_printable),
        cmocka_unit_test(test_places),
        cmocka_unit_test(test_base64),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
