// test_study.c - what answers say, against closed forms and published scores
#include "site/study/statistics.h"

#include "test.h"

static char folder[64];

static void analyse(struct relume_study_result *r, const char *text)
{
    char path[128];
    const char *const paths[] = {path};
    snprintf(path, sizeof path, "%s/answers.csv", folder);
    test_write(path, text, strlen(text));
    CHECK_OK(relume_study_analyse(r, paths, 1, NULL));
}

// Meseth 2008, Tabs 13.1 to 13.3: realism of nine images as photograph, BTF and standard material,
// by 22 people, twice; without the two rows of which a score is lost.
struct row {
    const char *condition;
    int score[22];
};
static const struct row published[] = {
    {"P", {9, 7, 8, 7, 6, 8, 1, 9, 9, 7, 6, 6, 1, 7, 7, 6, 6, 6, 8, 10, 9, 8}},
    {"P", {9, 9, 3, 7, 6, 1, 1, 6, 6, 7, 6, 5, 1, 6, 7, 5, 5, 5, 9, 8, 9, 9}},
    {"P", {10, 10, 10, 10, 9, 6, 10, 2, 4, 9, 8, 8, 9, 6, 5, 10, 6, 4, 8, 10, 10, 5}},
    {"P", {9, 10, 10, 10, 9, 3, 8, 2, 8, 7, 1, 8, 9, 3, 5, 10, 7, 1, 8, 8, 8, 5}},
    {"P", {10, 10, 10, 8, 8, 2, 9, 8, 6, 8, 8, 8, 9, 2, 9, 9, 9, 7, 9, 4, 10, 2}},
    {"P", {10, 10, 10, 9, 9, 5, 8, 8, 7, 9, 6, 8, 8, 3, 7, 9, 8, 4, 8, 5, 9, 5}},
    {"P", {10, 10, 9, 10, 8, 4, 8, 9, 4, 9, 8, 8, 9, 6, 7, 10, 9, 6, 9, 10, 10, 6}},
    {"P", {10, 10, 8, 10, 8, 3, 10, 8, 9, 8, 6, 8, 9, 6, 7, 10, 9, 8, 8, 10, 10, 4}},
    {"P", {8, 9, 10, 8, 6, 3, 8, 8, 3, 8, 8, 8, 8, 4, 6, 9, 8, 7, 7, 6, 8, 4}},
    {"P", {8, 10, 7, 10, 8, 5, 9, 7, 4, 9, 6, 7, 8, 5, 7, 7, 9, 6, 7, 10, 9, 6}},
    {"P", {9, 8, 8, 7, 6, 1, 1, 9, 5, 6, 8, 7, 8, 6, 8, 9, 5, 10, 9, 8, 10, 1}},
    {"P", {10, 10, 10, 8, 6, 5, 1, 7, 8, 8, 7, 7, 1, 6, 8, 6, 5, 8, 9, 6, 10, 10}},
    {"P", {6, 6, 10, 7, 7, 8, 1, 4, 7, 9, 6, 5, 4, 4, 8, 5, 4, 3, 5, 4, 7, 2}},
    {"P", {4, 6, 9, 8, 7, 9, 1, 3, 4, 8, 5, 4, 1, 4, 8, 5, 2, 3, 9, 3, 6, 1}},
    {"P", {7, 5, 10, 8, 6, 3, 10, 5, 8, 8, 7, 6, 9, 7, 4, 10, 2, 9, 5, 6, 8, 5}},
    {"P", {4, 6, 8, 7, 9, 1, 10, 3, 7, 7, 6, 7, 7, 6, 6, 10, 2, 3, 2, 6, 6, 3}},
    {"P", {10, 10, 10, 10, 6, 1, 8, 8, 7, 8, 3, 7, 9, 4, 9, 10, 8, 6, 7, 3, 8, 5}},
    {"P", {8, 10, 9, 9, 9, 2, 10, 6, 8, 8, 4, 6, 9, 4, 9, 10, 7, 3, 6, 8, 7, 9}},
    {"B", {10, 10, 6, 9, 7, 1, 2, 7, 7, 7, 7, 6, 4, 6, 5, 8, 3, 7, 8, 4, 10, 8}},
    {"B", {10, 10, 10, 10, 9, 8, 8, 9, 8, 8, 10, 7, 9, 5, 7, 10, 6, 6, 9, 3, 10, 2}},
    {"B", {10, 10, 10, 10, 8, 8, 8, 9, 5, 8, 8, 7, 9, 7, 7, 10, 8, 7, 8, 8, 10, 4}},
    {"B", {10, 10, 8, 8, 8, 1, 7, 9, 5, 8, 8, 8, 9, 5, 7, 7, 9, 8, 9, 5, 10, 1}},
    {"B", {8, 10, 10, 9, 8, 5, 4, 5, 5, 8, 6, 8, 9, 5, 8, 6, 8, 2, 9, 9, 8, 3}},
    {"B", {10, 10, 9, 8, 6, 1, 8, 6, 9, 8, 8, 7, 9, 5, 7, 10, 6, 6, 7, 7, 10, 4}},
    {"B", {9, 10, 8, 10, 8, 5, 8, 9, 8, 9, 6, 7, 9, 6, 7, 8, 4, 4, 8, 10, 10, 6}},
    {"B", {10, 10, 9, 8, 6, 1, 8, 6, 3, 7, 4, 8, 7, 3, 5, 8, 3, 7, 8, 4, 8, 2}},
    {"B", {9, 7, 8, 7, 7, 1, 1, 8, 6, 8, 1, 6, 4, 4, 8, 7, 7, 7, 8, 8, 10, 10}},
    {"B", {8, 7, 10, 7, 5, 3, 1, 8, 4, 7, 7, 6, 1, 3, 8, 6, 7, 8, 9, 3, 10, 7}},
    {"B", {9, 8, 8, 8, 8, 4, 1, 7, 6, 6, 4, 5, 3, 7, 8, 5, 6, 7, 8, 5, 9, 4}},
    {"B", {8, 8, 10, 8, 7, 1, 1, 3, 8, 7, 5, 4, 1, 6, 7, 5, 6, 7, 8, 7, 10, 3}},
    {"B", {9, 10, 9, 9, 7, 3, 9, 6, 6, 8, 5, 6, 6, 5, 7, 8, 5, 8, 4, 3, 7, 2}},
    {"B", {7, 10, 8, 9, 7, 1, 9, 4, 8, 6, 6, 6, 9, 7, 7, 10, 7, 10, 2, 5, 7, 7}},
    {"B", {7, 9, 10, 9, 6, 5, 8, 9, 4, 7, 4, 7, 8, 5, 8, 9, 7, 8, 9, 5, 9, 4}},
    {"B", {8, 10, 10, 9, 8, 1, 8, 7, 6, 6, 7, 8, 9, 6, 8, 9, 5, 4, 9, 4, 10, 8}},
    {"S", {4, 5, 8, 7, 7, 2, 1, 4, 4, 6, 5, 6, 5, 6, 5, 6, 3, 7, 8, 4, 7, 1}},
    {"S", {2, 6, 9, 7, 8, 2, 1, 3, 4, 5, 6, 4, 1, 4, 5, 4, 2, 3, 6, 2, 4, 3}},
    {"S", {7, 8, 4, 10, 7, 1, 9, 4, 8, 6, 4, 5, 8, 4, 6, 9, 5, 7, 8, 4, 10, 2}},
    {"S", {4, 7, 3, 10, 6, 1, 8, 3, 8, 7, 7, 7, 9, 6, 5, 10, 4, 4, 4, 2, 10, 7}},
    {"S", {3, 7, 3, 9, 6, 5, 9, 3, 8, 6, 8, 6, 9, 5, 6, 10, 5, 2, 8, 2, 9, 2}},
    {"S", {4, 7, 3, 9, 7, 6, 8, 4, 8, 7, 6, 7, 9, 5, 6, 10, 3, 3, 4, 4, 10, 8}},
    {"S", {6, 9, 2, 7, 2, 3, 5, 2, 4, 7, 1, 7, 6, 3, 6, 7, 4, 2, 1, 4, 6, 1}},
    {"S", {2, 5, 4, 7, 5, 3, 8, 2, 8, 5, 7, 5, 8, 2, 5, 7, 4, 4, 1, 3, 8, 5}},
    {"S", {3, 5, 5, 7, 5, 1, 1, 2, 4, 5, 4, 6, 9, 2, 5, 7, 3, 6, 4, 1, 2, 1}},
    {"S", {2, 5, 5, 7, 7, 2, 3, 1, 4, 5, 6, 5, 8, 2, 4, 5, 2, 2, 1, 1, 5, 1}},
    {"S", {9, 5, 8, 7, 5, 3, 1, 3, 4, 5, 6, 6, 6, 5, 5, 6, 2, 8, 7, 3, 3, 1}},
    {"S", {2, 5, 7, 7, 6, 2, 1, 2, 4, 4, 5, 5, 1, 3, 5, 5, 3, 5, 2, 3, 5, 1}},
    {"S", {7, 6, 8, 8, 4, 9, 6, 2, 4, 7, 5, 4, 5, 4, 4, 6, 6, 8, 2, 4, 7, 4}},
    {"S", {4, 7, 9, 8, 7, 1, 1, 2, 8, 8, 7, 5, 1, 4, 5, 5, 2, 3, 3, 3, 6, 2}},
    {"S", {4, 5, 2, 8, 6, 1, 9, 4, 6, 5, 3, 5, 4, 4, 5, 10, 2, 3, 8, 3, 8, 1}},
    {"S", {3, 6, 3, 10, 6, 1, 10, 2, 7, 5, 1, 6, 6, 4, 5, 8, 2, 1, 4, 2, 8, 4}},
    {"S", {7, 9, 4, 9, 7, 5, 6, 5, 9, 8, 8, 6, 9, 2, 5, 10, 4, 4, 5, 6, 10, 1}},
    {"S", {3, 8, 3, 9, 6, 3, 8, 2, 7, 6, 6, 6, 9, 5, 5, 9, 2, 3, 7, 2, 10, 9}},
};
enum { ROWS = sizeof published / sizeof *published, PEOPLE = 22 };

static void test_published(void **state)
{
    (void)state;
    char *text = malloc(1 << 16), *at = text;
    struct relume_study_result r;
    assert_int_equal(ROWS, 52);
    at += sprintf(at, "subject,condition,image,score\n");
    for (int i = 0; i < ROWS; i++)
        for (int s = 0; s < PEOPLE; s++)
            at +=
                sprintf(at, "%c,%s,1,%d\n", 'A' + s, published[i].condition, published[i].score[s]);
    analyse(&r, text);
    free(text);
    assert_int_equal(r.questions, 0);
    assert_int_equal(r.ratings.conditions, 3);
    assert_int_equal(r.ratings.subjects, PEOPLE);
    // the alphabet: B, P, S
    assert_int_equal(r.ratings.count[1], 396);
    assert_int_equal(r.ratings.count[0], 352);
    CHECK_NEAR(r.ratings.raw[1], 6.90, 0.005);
    CHECK_NEAR(r.ratings.raw[2], 5.06, 0.005);
    CHECK_NEAR(r.ratings.mean[1], 0.306, 5e-4);
    CHECK_NEAR(r.ratings.mean[0], 0.301, 5e-4);
    CHECK_NEAR(r.ratings.mean[2], -0.574, 5e-4);
    CHECK_NEAR(r.ratings.difference[3 * 1 + 0], 0.005, 5e-4);
    CHECK_NEAR(r.ratings.t[3 * 1 + 0], 0.1, 0.05);
    assert_int_equal(r.ratings.positive[3 * 1 + 0], 11);
    CHECK_NEAR(r.ratings.difference[3 * 0 + 2], 0.875, 5e-4);
    CHECK_NEAR(r.ratings.t[3 * 0 + 2], 7.6, 0.05);
    assert_int_equal(r.ratings.positive[3 * 0 + 2], 22);
    relume_study_free(&r);
}

static void test_distributions(void **state)
{
    (void)state;
    CHECK_NEAR(relume_study_chi_squared_p(3.841459, 1), 0.05, 1e-6);
    CHECK_NEAR(relume_study_chi_squared_p(5.991465, 2), 0.05, 1e-6);
    CHECK_NEAR(relume_study_chi_squared_p(7.814728, 3), 0.05, 1e-6);
    CHECK_NEAR(relume_study_chi_squared_p(18.307038, 10), 0.05, 1e-6);
    CHECK_NEAR(relume_study_chi_squared_p(19.675138, 11), 0.05, 1e-6);
    CHECK_NEAR(relume_study_chi_squared_p(0.0, 4), 1.0, 0.0);
    CHECK_NEAR(relume_study_normal_z(0.975), 1.959964, 1e-6);
    CHECK_NEAR(relume_study_normal_z(0.5), 0.0, 1e-9);
}

// Three conditions at 0, 1 and 2 on Thurstone's scale: shares by the normal distribution.
static void test_thurstone(void **state)
{
    (void)state;
    enum { N = 2000 };
    static const char *const name[] = {"a", "b", "c"};
    char *text = malloc(3 * N * 64 + 100), *at = text;
    struct relume_study_result r;
    at += sprintf(at, "subject,trial,question,scene,left,right,chosen,seconds\n");
    for (int i = 0; i < 3; i++)
        for (int j = i + 1; j < 3; j++) {
            const double share = 0.5 * erfc(-(j - i) / sqrt(2.0));
            for (int k = 0; k < N; k++)
                at += sprintf(at, "%d,%d,\"Brighter, or \"\"not\"\"?\",x,%s,%s,%s,0.1\n", k % 7, k,
                              name[i], name[j], name[k < share * N ? j : i]);
        }
    analyse(&r, text);
    free(text);
    assert_int_equal(r.questions, 1);
    const struct relume_study_pairs *p = &r.pairs[0];
    assert_string_equal(p->question, "Brighter, or \"not\"?");
    assert_int_equal(p->answers, 3 * N);
    assert_int_equal(p->subjects, 7);
    for (int i = 0; i < 3; i++)
        CHECK_NEAR(p->scale[i], i - 1.0, 0.01);
    const double won = p->wins[3 * 1 + 0], lost = p->wins[3 * 0 + 1];
    CHECK_NEAR(won + lost, N, 0.0);
    CHECK_NEAR(p->chi_squared[1], (won - lost) * (won - lost) / N, 1e-9);
    assert_true(p->p[1] < 1e-10);
    relume_study_free(&r);
}

static void refused(const char *text, relume_status want, const char *says)
{
    char path[128];
    const char *const paths[] = {path};
    struct relume_study_result r;
    struct test_log log;
    test_log_init(&log);
    snprintf(path, sizeof path, "%s/bad.csv", folder);
    test_write(path, text, strlen(text));
    assert_int_equal(relume_study_analyse(&r, paths, 1, &log.log), want);
    assert_non_null(strstr(log.text, says));
    assert_null(r.pairs);
}

static void test_refused(void **state)
{
    (void)state;
    refused("", RELUME_EFORMAT, "line 1");
    refused("a,b\n", RELUME_EFORMAT, "line 1");
    refused("subject,question,left,right,chosen\n", RELUME_EUNFIT, "no answers");
    refused("subject,question,left,right,chosen\n1,q,a,b,c\n", RELUME_EFORMAT, "line 2");
    refused("subject,question,left,right,chosen\n1,q,a,a,a\n", RELUME_EFORMAT, "line 2");
    refused("subject,question,left,right,chosen\n1,q,a,b,a\n1,q\n", RELUME_EFORMAT, "line 3");
    refused("subject,question,left,right,chosen\n1,\"q,a,b,a\n", RELUME_EFORMAT, "line 2");
    refused("subject,condition,score\n1,a,nan\n", RELUME_EFORMAT, "line 2");
    refused("subject,condition,score\n1,a,\n", RELUME_EFORMAT, "line 2");
    // 256 conditions, and one more
    char text[8192];
    int n = snprintf(text, sizeof text, "subject,condition,score\n");
    for (int i = 0; i < 257; i++)
        n += snprintf(text + n, sizeof text - (size_t)n, "1,c%d,%d\n", i, i % 7);
    refused(text, RELUME_ELIMIT, "line 258");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_published),
        cmocka_unit_test(test_distributions),
        cmocka_unit_test(test_thurstone),
        cmocka_unit_test(test_refused),
    };
    test_folder(folder);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    test_folder_remove(folder);
    return failed;
}
