// test_lp.c - .lp files; the rows of the "broken input" table that need no pictures
#include "test.h"

#include "capture/manifest/manifest.h"

static char folder[64], path[96];

static int setup(void **state)
{
    (void)state;
    test_folder(folder);
    snprintf(path, sizeof path, "%s/x.lp", folder);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

static relume_status read_text(struct draft *d, const char *text, struct test_log *log)
{
    test_log_init(log);
    test_write(path, text, strlen(text));
    return lp_read(d, path, NULL, &log->log);
}

static void test_good(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "2\na b.jpg 0 0 2\nC:\\x\\c.jpg 3 0 0\n",
        "2\r\na b.jpg 0 0 2\r\nC:\\x\\c.jpg 3 0 0",
        "\xef\xbb\xbf"
        "2\na b.jpg 0 0 2 \t\nC:\\x\\c.jpg 3 0 0  \r\n",
        "\n\n  2  \n\n a b.jpg\t0\t0\t2\n\nC:\\x\\c.jpg 3e0 0,0 0\n\n",
        "2\na b.jpg 0, 0, 2,\nC:\\x\\c.jpg 3, 0, 0,\n",
        "2\na b.jpg 0,0 0,0 2,0\nC:\\x\\c.jpg 3 -0 +0\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct draft d;
        struct test_log log;
        CHECK_OK(read_text(&d, texts[i], &log));
        assert_int_equal(log.lines, 0);
        assert_int_equal(d.m.lights, 2);
        assert_string_equal(d.view[0].images[0], "a b.jpg");
        assert_string_equal(d.view[0].images[1], "C:\\x\\c.jpg");
        CHECK_NEAR(d.directions[0].z, 1.0, 0.0);
        CHECK_NEAR(d.directions[1].x, 1.0, 0.0);
        draft_free(&d);
    }
}

static void test_wrong_counts_are_warnings(void **state)
{
    (void)state;
    struct draft d;
    struct test_log log;
    CHECK_OK(read_text(&d, "9\na 0 0 1\n", &log));
    assert_int_equal(d.m.lights, 1);
    assert_non_null(strstr(log.text, "promises 9 lights; found 1"));
    draft_free(&d);
    CHECK_OK(read_text(&d, "1\na 0 0 1\nb 0 1 0\n", &log));
    assert_int_equal(d.m.lights, 2);
    assert_int_equal(log.lines, 1);
    draft_free(&d);
}

static void test_bad(void **state)
{
    (void)state;
    static const struct {
        const char *text, *said;
    } rows[] = {
        {"", "no lights"},
        {"\n \n", "no lights"},
        {"3\n", "no lights"},
        {"0\n", "line 1; expected the number of lights or 'image x y z', found '0'"},
        {"-2\na 0 0 1\n", "line 1; expected the number of lights"},
        {"a 0 1\n", "line 1; expected the number of lights"},
        {"a 0 0 1\n2\n", "line 2; expected 'image x y z', found '2'"},
        {"1 2\na 0 0 1\n", "line 1; expected the number of lights"},
        {"1.5\na 0 0 1\n", "line 1; expected the number of lights"},
        {"1\na 0 0 0\n", "line 2; expected a light direction"},
        {"1\na 1e-9 0 0\n", "line 2; expected a light direction"},
        {"1\na nan 0 1\n", "line 2; expected a light direction"},
        {"1\na 0 inf 1\n", "line 2; expected a light direction"},
        {"1\na 1e300 1e300 1\n", "line 2; expected a light direction"},
        {"1\na 0 1\n", "line 2; expected 'image x y z'"},
        {"1\n0 0 1\n", "line 2; expected 'image x y z'"},
        {"1\na x y z\n", "line 2; expected 'image x y z'"},
        {"1\na 0,0,1\n", "line 2; expected 'image x y z'"},
        {"1\na 0 1,5,5 1\n", "line 2; expected 'image x y z'"},
        {"1\n\n\na 0 0 1x\n", "line 4; expected 'image x y z'"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct draft d;
        struct test_log log;
        assert_int_equal(read_text(&d, rows[i].text, &log), RELUME_EFORMAT);
        assert_int_equal(log.lines, 1);
        if (!strstr(log.text, rows[i].said) || !strstr(log.text, path))
            fail_msg("'%s': found '%s', expected '%s'", rows[i].text, log.text, rows[i].said);
        assert_null(d.directions);
    }
    struct draft d;
    struct test_log log;
    test_log_init(&log);
    test_write(path, "1\na\0b 0 0 1\n", 12);
    assert_int_equal(lp_read(&d, path, NULL, &log.log), RELUME_EFORMAT);
    assert_non_null(strstr(log.text, "not a text file"));
    const struct relume_limits two = {.max_lights = 2};
    test_write(path, "3\na 0 0 1\na 0 0 1\na 0 0 1\n", 26);
    assert_int_equal(lp_read(&d, path, &two, &log.log), RELUME_ELIMIT);
    assert_non_null(strstr(log.text, "3 lights; expected at most 2"));
    assert_int_equal(lp_read(&d, folder, NULL, &log.log), RELUME_ENOTFOUND);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_good),
        cmocka_unit_test(test_wrong_counts_are_warnings),
        cmocka_unit_test(test_bad),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
