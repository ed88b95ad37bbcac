// test_json_writer.c - known texts, their way back through jansson, short memory, a comma as point
#include "test.h"

#include "core/base/json.h"
#include "core/base/json_write.h"
#include "core/base/memory.h"
#include "core/math/base64.h"

#include <float.h>
#include <limits.h>
#include <locale.h>
#include <sys/stat.h>

// What the writer holds, with all levels closed.
static void check_text(struct jwriter *w, const char *expected)
{
    size_t size;
    char *text = jtake(w, &size);
    assert_non_null(text);
    assert_string_equal(text, expected);
    assert_int_equal(size, strlen(expected));
    mem_free(text);
}

static void test_values(void **state)
{
    (void)state;
    const char *const names[] = {"a", NULL, ""};
    struct jwriter w = {0};
    jopen_object(&w, NULL);
    jput_text(&w, "text", "x");
    jput_text(&w, "none", NULL);
    jput_truth(&w, "yes", true);
    jput_truth(&w, "no", false);
    jput_null(&w, "null");
    jput_integer(&w, "n", -7);
    jput_raw(&w, "raw", "[1,2]");
    jput_raw(&w, "no raw", NULL);
    jput_texts(&w, "texts", names, 3);
    jput_numbers(&w, "numbers", (const double[]){0.5, NAN}, 2, 9);
    jput_floats(&w, "floats", (const float[]){0.1f}, 1, 9);
    jput_vector(&w, "vector", (struct relume_vec3){1.0, -2.0, 3.25}, 9);
    jput_numbers(&w, "empty", NULL, 0, 9);
    check_text(&w, "{\"text\": \"x\", \"none\": null, \"yes\": true, \"no\": false, "
                   "\"null\": null, \"n\": -7, \"raw\": [1,2], \"no raw\": null, "
                   "\"texts\": [\"a\", null, \"\"], \"numbers\": [0.5, null], "
                   "\"floats\": [0.100000001], \"vector\": [1, -2, 3.25], \"empty\": []}");
}

static void test_layout(void **state)
{
    (void)state;
    struct jwriter w = {0};
    jopen_object(&w, NULL);
    jgap(&w, "\n  ");
    jput_integer(&w, "a", 1);
    jgap(&w, "\n  ");
    jopen_array(&w, "b");
    jopen_array(&w, NULL);
    jclose(&w);
    jopen_object(&w, NULL);
    jclose(&w);
    jclose(&w);
    jgap(&w, "\n");
    CHECK_OK(jend(&w));
    check_text(&w, "{\n  \"a\": 1,\n  \"b\": [[], {}]\n}\n");
    w = (struct jwriter){.style = JSON_DENSE};
    jopen_object(&w, NULL);
    jput_integer(&w, "a", 1);
    jput_numbers(&w, "b", (const double[]){1.0, 2.0}, 2, 9);
    check_text(&w, "{\"a\":1,\"b\":[1,2]}");
}

static char *written(const char *text, unsigned style)
{
    struct jwriter w = {.style = style};
    jput_text(&w, NULL, text);
    char *json = jtake(&w, NULL);
    assert_non_null(json);
    return json;
}

static void check_escape(const char *text, unsigned style, const char *expected)
{
    char *json = written(text, style);
    assert_string_equal(json, expected);
    mem_free(json);
}

static void test_escapes(void **state)
{
    (void)state;
    check_escape("a\"b\\c/d", 0, "\"a\\\"b\\\\c/d\"");
    check_escape("\b\f\n\r\t", 0, "\"\\b\\f\\n\\r\\t\"");
    check_escape("\x01\x1f", 0, "\"\\u0001\\u001f\"");
    check_escape("\xc3\xa9\xf0\x9f\x92\xa1", 0, "\"\xc3\xa9\xf0\x9f\x92\xa1\"");
    // bytes that are not UTF-8: a lone one, an overlong slash, half a surrogate, a cut character
    check_escape("\xff", 0, "\"\\ufffd\"");
    check_escape("\xc0\xaf", 0, "\"\\ufffd\\ufffd\"");
    check_escape("\xed\xa0\x80", 0, "\"\\ufffd\\ufffd\\ufffd\"");
    check_escape("a\xe2\x82", 0, "\"a\\ufffd\\ufffd\"");
    // what a terminal obeys: escape, C1, a turn of direction, a tag beyond the first 65536
    check_escape("\x1b[31m", 0, "\"\\u001b[31m\"");
    check_escape("\x7f\xc2\x9b\xe2\x80\xae\xf3\xa0\x80\x81", 0,
                 "\"\x7f\xc2\x9b\xe2\x80\xae\xf3\xa0\x80\x81\"");
    check_escape("\x7f\xc2\x9b\xe2\x80\xae\xf3\xa0\x80\x81", JSON_TERMINAL,
                 "\"\\u007f\\u009b\\u202e\\udb40\\udc01\"");
    check_escape("</script>&", 0, "\"</script>&\"");
    check_escape("</script>&", JSON_MARKUP, "\"\\u003c/script\\u003e\\u0026\"");
}

// Each character comes back from the text as jansson reads it; keys are escaped like values.
static void test_escapes_read_back(void **state)
{
    (void)state;
    static const unsigned styles[] = {0, JSON_DENSE, JSON_TERMINAL, JSON_MARKUP | JSON_TERMINAL};
    char all[0x80 + 16];
    for (int i = 1; i < 0x80; i++)
        all[i - 1] = (char)i;
    strcpy(all + 0x7f, "\xe2\x80\xa8\xf3\xa0\x80\x81\xc3\xa9");
    for (size_t i = 0; i < sizeof styles / sizeof *styles; i++) {
        struct jwriter w = {.style = styles[i]};
        jvalue *root;
        jopen_object(&w, NULL);
        jput_text(&w, all, all);
        char *text = jtake(&w, NULL);
        assert_non_null(text);
        CHECK_OK(jvalue_parse(&root, text, NULL));
        assert_string_equal(jvalue_text(jvalue_member(root, all)), all);
        jvalue_free(&root);
        mem_free(text);
    }
}

static void check_number(double value, int digits, const char *expected)
{
    struct jwriter w = {0};
    jput_number(&w, NULL, value, digits);
    check_text(&w, expected);
}

static void check_fixed(double value, int decimals, const char *expected)
{
    struct jwriter w = {0};
    jput_fixed(&w, NULL, value, decimals);
    check_text(&w, expected);
}

static void test_numbers(void **state)
{
    (void)state;
    check_number(0.1, 0, "0.1");
    check_number(1.0 / 3.0, 0, "0.33333333333333331");
    check_number(1.0 / 3.0, 4, "0.3333");
    check_number(1e21, 0, "1e+21");
    check_number(-0.0, 0, "-0");
    check_number(DBL_MAX, 0, "1.7976931348623157e+308");
    check_number(5e-324, 0, "4.94065645841247e-324");
    check_number(1.0 / 3.0, 99, "0.33333333333333331");
    check_number(NAN, 0, "null");
    check_number(-INFINITY, 9, "null");
    check_fixed(2.0 / 3.0, 2, "0.67");
    check_fixed(1e15, 0, "1000000000000000");
    check_fixed(NAN, 2, "null");
    check_fixed(INFINITY, 0, "null");
    struct jwriter w = {0};
    jput_integer(&w, NULL, LLONG_MIN);
    check_text(&w, "-9223372036854775808");
}

static double read_number(const char *text)
{
    jvalue *root;
    double value = NAN;
    CHECK_OK(jvalue_parse(&root, text, NULL));
    assert_true(jvalue_number(jvalue_item(root, 0), &value));
    jvalue_free(&root);
    return value;
}

static void test_numbers_read_back(void **state)
{
    (void)state;
    uint64_t bits = 0x9e3779b97f4a7c15u;
    int finite = 0;
    for (int i = 0; i < 20000; i++) {
        double value;
        bits = bits * 6364136223846793005u + 1442695040888963407u;
        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value))
            continue;
        struct jwriter w = {0};
        jput_numbers(&w, NULL, &value, 1, 0);
        char *text = jtake(&w, NULL);
        assert_non_null(text);
        assert_true(read_number(text) == value);
        mem_free(text);
        finite++;
    }
    assert_true(finite > 19000);
    // the largest in fixed form has 309 digits, all of which are there
    struct jwriter w = {0};
    jopen_array(&w, NULL);
    jput_fixed(&w, NULL, -DBL_MAX, 17);
    char *text = jtake(&w, NULL);
    assert_true(read_number(text) == -DBL_MAX);
    assert_int_equal(strlen(text), 2 + 1 + 309 + 1 + 17);
    mem_free(text);
}

static void test_depth(void **state)
{
    (void)state;
    struct jwriter w = {0};
    for (int i = 0; i < 64; i++)
        jopen_array(&w, NULL);
    CHECK_OK(jend(&w));
    assert_int_equal(w.size, 2 * 64 + 1);
    jdrop(&w);
    w = (struct jwriter){0};
    for (int i = 0; i < 65; i++)
        jopen_array(&w, NULL);
    assert_int_equal(jend(&w), RELUME_EINVAL);
    jdrop(&w);
    // objects and arrays in turn: each bracket closes what it opened
    w = (struct jwriter){0};
    for (int i = 0; i < 8; i++) {
        jopen_object(&w, i ? NULL : NULL);
        jopen_array(&w, "k");
    }
    jclose_levels(&w, 15);
    jput_truth(&w, "last", true);
    char *text = jtake(&w, NULL);
    jvalue *root;
    CHECK_OK(jvalue_parse(&root, text, NULL));
    bool last = false;
    assert_true(jvalue_truth(jvalue_member(root, "last"), &last) && last);
    jvalue_free(&root);
    mem_free(text);
}

static void test_misuse(void **state)
{
    (void)state;
    struct jwriter w = {0};
    jput_integer(&w, "key of no object", 1);
    assert_int_equal(jend(&w), RELUME_EINVAL);
    jdrop(&w);
    w = (struct jwriter){0};
    jopen_object(&w, NULL);
    jput_integer(&w, NULL, 1);
    assert_null(jtake(&w, NULL));
    w = (struct jwriter){0};
    jput_integer(&w, NULL, 1);
    jput_integer(&w, NULL, 2);  // a second document
    assert_int_equal(jend(&w), RELUME_EINVAL);
    jdrop(&w);
    w = (struct jwriter){0};
    jclose(&w);
    assert_int_equal(jend(&w), RELUME_EINVAL);
    jdrop(&w);
    w = (struct jwriter){0};
    jfail(&w, RELUME_EUNFIT);  // of the caller; the first counts
    jfail(&w, RELUME_ENOMEM);
    jput_integer(&w, NULL, 1);
    assert_int_equal(jend(&w), RELUME_EUNFIT);
    assert_int_equal(w.size, 0);
    jdrop(&w);
}

static void put_much(struct jwriter *w)
{
    jopen_array(w, NULL);
    for (int i = 0; i < 4000; i++)
        jput_text(w, NULL, "some text");
    jopen_object(w, NULL);
    base64_put(w, "bytes", "relume", 6);
    jclose(w);
}

static void test_short_memory(void **state)
{
    (void)state;
    int failed = 0;
    for (bool done = false; !done; failed++) {
        struct jwriter w = {0};
        mem_fail_after(failed + 1);
        put_much(&w);
        char *text = jtake(&w, NULL);
        done = mem_fail_pending();
        mem_fail_after(0);
        assert_true((text != NULL) == done);
        if (text)
            assert_non_null(strstr(text, "{\"bytes\": \"cmVsdW1l\"}]"));
        mem_free(text);
        assert_null(w.text);
    }
    assert_in_range(failed, 4, 40);  // memory doubles
}

static void test_stream(void **state)
{
    (void)state;
    char *text = NULL;
    size_t size = 0;
    struct jwriter w = {.file = open_memstream(&text, &size)};
    put_much(&w);
    CHECK_OK(jend(&w));
    fclose(w.file);
    struct jwriter memory = {0};
    put_much(&memory);
    CHECK_OK(jend(&memory));
    assert_int_equal(memory.size, size);
    assert_memory_equal(memory.text, text, size);
    jdrop(&memory);
    free(text);
    struct jwriter full = {.file = fopen("/dev/full", "w")};
    if (!full.file)
        return;
    put_much(&full);
    assert_int_equal(jend(&full), RELUME_EIO);
    fclose(full.file);
}

static void test_files(void **state)
{
    (void)state;
    char folder[64], path[96];
    struct test_log log;
    test_log_init(&log);
    test_folder(folder);
    struct jwriter w = {0};
    put_much(&w);
    CHECK_OK(jsave_in(&w, folder, "a.json", NULL));
    assert_null(w.text);
    snprintf(path, sizeof path, "%s/a.json", folder);
    jvalue *root;
    CHECK_OK(jvalue_load(&root, path, NULL));
    assert_int_equal(jvalue_count(root), 4001);
    jvalue_free(&root);
    w = (struct jwriter){0};
    put_much(&w);
    assert_int_equal(jsave_in(&w, folder, "absent/a.json", &log.log), RELUME_EIO);
    assert_non_null(strstr(log.text, "absent/a.json"));
    // an error of the writer leaves no file
    w = (struct jwriter){0};
    jfail(&w, RELUME_ENOMEM);
    assert_int_equal(jsave_in(&w, folder, "b.json", NULL), RELUME_ENOMEM);
    snprintf(path, sizeof path, "%s/b.json", folder);
    assert_int_equal(access(path, F_OK), -1);
    test_folder_remove(folder);
}

// LC_NUMERIC of glibc with a comma as decimal point, as localedef writes it.
static const unsigned char comma[] = {
    0x14, 0x11, 0x03, 0x20, 0x06, 0x00, 0x00, 0x00, 0x20, 0x00, 0x00, 0x00, 0x22, 0x00, 0x00,
    0x00, 0x23, 0x00, 0x00, 0x00, 0x24, 0x00, 0x00, 0x00, 0x28, 0x00, 0x00, 0x00, 0x2c, 0x00,
    0x00, 0x00, 0x2c, 0x00, 0x00, 0x00, 0x2c, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x41,
    0x4e, 0x53, 0x49, 0x5f, 0x58, 0x33, 0x2e, 0x34, 0x2d, 0x31, 0x39, 0x36, 0x38, 0x00};

static void test_locale(void **state)
{
    (void)state;
    char folder[64], path[96];
    test_folder(folder);
    snprintf(path, sizeof path, "%s/comma", folder);
    assert_int_equal(mkdir(path, 0777), 0);
    snprintf(path, sizeof path, "%s/comma/LC_NUMERIC", folder);
    test_write(path, comma, sizeof comma);
    setenv("LOCPATH", folder, 1);
    const bool there = setlocale(LC_NUMERIC, "comma") != NULL;
    unsetenv("LOCPATH");
    test_folder_remove(folder);
    if (!there)
        skip();
    assert_string_equal(localeconv()->decimal_point, ",");
    check_number(0.5, 0, "0.5");
    check_number(1.0 / 3.0, 0, "0.33333333333333331");
    check_number(-1.5e-9, 9, "-1.5e-09");
    check_fixed(1234567.25, 2, "1234567.25");
    assert_string_equal(jnumber_text(2.5).text, "2.5");
    setlocale(LC_NUMERIC, "C");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),       cmocka_unit_test(test_layout),
        cmocka_unit_test(test_escapes),      cmocka_unit_test(test_escapes_read_back),
        cmocka_unit_test(test_numbers),      cmocka_unit_test(test_numbers_read_back),
        cmocka_unit_test(test_depth),        cmocka_unit_test(test_misuse),
        cmocka_unit_test(test_short_memory), cmocka_unit_test(test_stream),
        cmocka_unit_test(test_files),        cmocka_unit_test(test_locale),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
