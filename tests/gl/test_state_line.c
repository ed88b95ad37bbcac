// test_state_line.c - lines of a state: what was added comes back, what is wrong is refused
#include "test.h"

#include "cli/program/state_line.h"

enum { MOST = 8 };

static void test_round_trip(void **state)
{
    (void)state;
    static const char *const added[][2] = {
        {"light", "slide 1e-07 -2 3 0 0 -1 25 \"a b&c=d#e%,\xc3\xa4.png\" rgb 1 0.5 0"},
        {"eye", "1 2 3"},
        {"exposure", "-1.5"},
        {"light", "dir 0 0 1"},
    };
    // words of lights are separated by blanks, numbers of others by commas
    static const char *const read[] = {added[0][1], "1,2,3", "-1.5", "dir 0 0 1"};
    char line[STATE_LINE_MOST] = "", buffer[STATE_LINE_MOST], address[STATE_LINE_MOST + 40];
    struct state_entry entry[MOST];
    int n;
    for (size_t i = 0; i < 4; i++)
        assert_true(state_line_add(line, sizeof line, added[i][0], added[i][1]));
    assert_null(strpbrk(line, " \"#<>'"));
    snprintf(address, sizeof address, "https://a.org/b.html?c=d&e#%s", line);
    CHECK_OK(state_line_read(entry, &n, MOST, buffer, address, NULL));
    assert_int_equal(n, 4);
    for (int i = 0; i < n; i++) {
        assert_int_equal(strncmp(entry[i].option, "--", 2), 0);
        assert_string_equal(entry[i].option + 2, added[i][0]);
        assert_string_equal(entry[i].value, read[i]);
    }
    char small[20] = "pan=1";
    assert_true(state_line_add(small, sizeof small, "tilt", "2"));
    assert_false(state_line_add(small, sizeof small, "light", "dir 0 0 1"));
    assert_string_equal(small, "pan=1&tilt=2");
}

static void test_refused(void **state)
{
    (void)state;
    static const char *const wrong[] = {"light",     "light=%",      "light=%2",
                                        "light=a%2", "light=%zz",    "light=%00",
                                        "pan=%0a",   "pan=\x1b[31m", "pan=1&tilt"};
    static char many[STATE_LINE_MOST + 8], buffer[STATE_LINE_MOST];
    struct test_log log;
    struct state_entry entry[MOST];
    int n;
    test_log_init(&log);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        log.lines = 0;
        assert_int_equal(state_line_read(entry, &n, MOST, buffer, wrong[i], &log.log),
                         RELUME_EINVAL);
        assert_int_equal(log.lines, 1);
    }
    for (int i = 0; i < MOST + 1; i++)
        strcat(many, "pan=1&");
    assert_int_equal(state_line_read(entry, &n, MOST, buffer, many, &log.log), RELUME_EINVAL);
    memset(many, '1', sizeof many - 1);
    assert_int_equal(state_line_read(entry, &n, MOST, buffer, many, &log.log), RELUME_EINVAL);
    // options that write, or that nobody knows, are no part of a state
    log.lines = 0;
    CHECK_OK(state_line_read(entry, &n, MOST, buffer, "o=x&save-rig=y&at=1,2&file=z&\x1b=1&&pan=3&",
                             &log.log));
    assert_int_equal(n, 1);
    assert_int_equal(log.lines, 3);
    assert_null(strchr(log.text, '\x1b'));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
