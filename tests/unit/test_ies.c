// test_ies.c - photometric files: every header, every symmetry, and what is refused
#include "relight/light/environment.h"

#include "test.h"

static struct test_log heard;

static relume_ies *parse(const char *text)
{
    relume_ies *ies;
    test_log_init(&heard);
    const relume_status status = relume_ies_parse(&ies, text, strlen(text), "lamp.ies", &heard.log);
    assert_true(status == RELUME_OK || relume_status_is_input(status));
    assert_true((status == RELUME_OK) == (ies != NULL));
    return ies;
}

static void is(const char *text, double vertical, double horizontal, double want)
{
    relume_ies *ies = parse(text);
    if (!ies)
        fail_msg("%s", heard.text);
    CHECK_NEAR(relume_ies_value(ies, vertical, horizontal), want, 1e-6);
    relume_ies_destroy(&ies);
}

static void refused(const char *text, const char *why)
{
    relume_ies *ies = parse(text);
    relume_ies_destroy(&ies);
    if (heard.lines != 1 || !strstr(heard.text, why) || strncmp(heard.text, "lamp.ies: ", 10))
        fail_msg("expected '%s', found %d lines: '%s'", why, heard.lines, heard.text);
}

#define ROUND "1 1000 2 3 1 1 2 0 0 0 0.5 1 100\n0 45 90\n0\n50 100 0\n"

static void test_headers(void **state)
{
    (void)state;
    static const char *const heads[] = {
        "a lamp\nof 1986\nTILT=NONE\n",
        "IESNA91\n[TEST] x\nTILT=NONE\r\n",
        "IESNA:LM-63-1995\n[TEST] x\nTILT=NONE \n",
        "IESNA:LM-63-2002\n[TEST] TILT=NONSENSE\nTILT=INCLUDE\n1\n3\n0 90 180\n1 .9 .8\n",
        "TILT=NONE\n",
    };
    for (size_t i = 0; i < sizeof heads / sizeof *heads; i++) {
        char text[512];
        snprintf(text, sizeof text, "%s%s", heads[i], ROUND);
        is(text, 0, 12, 0.5);
        is(text, 45, 0, 1);
        is(text, 22.5, -300, 0.75);
        is(text, 67.5, 1e6, 0.5);
        is(text, 90, 0, 0);
        is(text, 91, 0, 0);  // outside what was measured
    }
    relume_ies *ies = parse("TILT=NONE\n" ROUND);
    CHECK_NEAR(relume_ies_candela(ies), 100, 1e-9);  // times multiplier 2 and ballast 0.5
    relume_ies_destroy(&ies);
}

#define HEAD(v, h) "TILT=NONE\n1 -1 1 " v " " h " 1 1 0 0 0 1 1 1\n"

static void test_symmetries(void **state)
{
    (void)state;
    static const char quarter[] = HEAD("2", "3") "0 180\n0 45 90\n4 4, 2 2\n0 0";
    is(quarter, 10, 0, 1);
    is(quarter, 10, 45, 0.5);
    is(quarter, 10, 135, 0.5);
    is(quarter, 10, 180, 1);
    is(quarter, 10, 202.5, 0.75);
    is(quarter, 10, -90, 0);
    static const char half[] = HEAD("2", "3") "0 180\n0 90 180\n4 4 2 2 0 0";
    is(half, 10, 90, 0.5);
    is(half, 10, 180, 0);
    is(half, 10, 270, 0.5);
    is(half, 10, 315, 0.75);
    static const char side[] = HEAD("2", "3") "0 180\n90 180 270\n4 4 2 2 0 0";
    is(side, 10, 90, 1);
    is(side, 10, 180, 0.5);
    is(side, 10, 0, 0.5);
    is(side, 10, 45, 0.75);
    is(side, 10, 315, 0.25);
    static const char whole[] = HEAD("2", "5") "90 180\n0 90 180 270 360\n4 4 3 3 2 2 1 1 4 4";
    is(whole, 100, 0, 1);
    is(whole, 100, 90, 0.75);
    is(whole, 100, 270, 0.25);
    is(whole, 100, -45, 0.625);
    is(whole, 89, 0, 0);
}

static void test_refusals(void **state)
{
    (void)state;
    refused("", "no line TILT=");
    refused("IESNA91\n1 2 3", "no line TILT=");
    refused("TILT=lamp.tlt\n" ROUND, "TILT=lamp.tlt; expected NONE or INCLUDE");
    refused("TILT=INCLUDE\n1\n-4\n", "number of tilt angles; expected 0 to 4096, found -4");
    refused("TILT=NONE\n", "number of lamps; expected a number, found the end");
    refused("TILT=NONE\n1 1000 1 3 1 2 2 0 0 0 1 1 1", "type B; expected type C");
    refused("TILT=NONE\n1 1000 1 3 1 3 2 0 0 0 1 1 1", "type A; expected type C");
    refused("TILT=NONE\n1 1000 0 3 1 1 2 0 0 0 1 1 1", "multiplier");
    refused(HEAD("1e9", "1") "0", "number of vertical angles; expected 1 to 4096");
    refused(HEAD("2.5", "1") "0", "number of vertical angles");
    refused(HEAD("4096", "4096") "0 1 2", "the file is shorter");
    refused(HEAD("2", "1") "0 90\n0\n5", "found the end of the file");
    refused(HEAD("2", "1") "0 90\n0\n5 4 3", "more numbers than its counts promise");
    refused(HEAD("2", "1") "0 1e30\n0\n5 4", "0 to 180");
    refused(HEAD("2", "1") "90 0\n0\n5 4", "ascending");
    refused(HEAD("1", "2") "0\n0 -90\n5 4", "0 to 360");
    refused(HEAD("1", "2") "0\n0 77\n5 4", "horizontal angles 0 to 77; expected 0,");
    refused(HEAD("2", "1") "0 90\n0\n5 -4", "expected 0 or more, found -4");
    refused(HEAD("2", "1") "0 90\n0\n5 nan", "expected a finite number");
    refused(HEAD("2", "1") "0 90\n0\n5 x", "expected a number, found x");
    refused(HEAD("2", "1") "0 90\n0\n0 0", "expected light");
}

static void test_files(void **state)
{
    (void)state;
    char folder[64], path[96];
    relume_ies *ies;
    test_folder(folder);
    snprintf(path, sizeof path, "%s/a.ies", folder);
    test_log_init(&heard);
    assert_int_equal(relume_ies_load(&ies, path, &heard.log), RELUME_ENOTFOUND);
    assert_non_null(strstr(heard.text, "cannot be opened"));
    test_write(path, "TILT=NONE\n" ROUND, sizeof "TILT=NONE\n" ROUND - 1);
    CHECK_OK(relume_ies_load(&ies, path, &heard.log));
    CHECK_NEAR(relume_ies_value(ies, 0, 0), 0.5, 1e-6);
    CHECK_NEAR(relume_ies_value(ies, NAN, 0), 0, 0);
    CHECK_NEAR(relume_ies_value(ies, 0, INFINITY), 0, 0);
    relume_ies_destroy(&ies);
    assert_int_equal(relume_ies_load(&ies, folder, &heard.log), RELUME_EFORMAT);
    test_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_headers),
        cmocka_unit_test(test_symmetries),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
