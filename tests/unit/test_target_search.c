// test_target_search.c - the search finds what trying everything finds, within its trials
#include "test.h"

#include "core/math/target_search.h"

// A staircase: as many of the steps as are at or below the argument.
struct stairs {
    double step[8];
    int steps, tried;
    relume_status status;  // of the third trial
};

static relume_status measure(void *context, double at, double *value)
{
    struct stairs *s = context;
    *value = 0.0;
    for (int i = 0; i < s->steps; i++)
        *value += at >= s->step[i];
    return ++s->tried == 3 ? s->status : RELUME_OK;
}

static double whole_middle(void *context, const struct target_bracket *b)
{
    (void)context;
    return floor((b->low + b->high) / 2.0);
}

static struct target_bracket find(struct stairs *s, double target, bool may_equal, double first)
{
    struct target_bracket b = {.low = -1.0, .high = 101.0, .at = first};
    CHECK_OK(target_search(&b, &(const struct target_search){.target = target,
                                                             .may_equal = may_equal,
                                                             .narrow = 1.0,
                                                             .measure = measure,
                                                             .guess = whole_middle,
                                                             .context = s}));
    return b;
}

// Every target and every beginning, against the first argument of all that passes.
static void test_every_target(void **state)
{
    (void)state;
    struct stairs s = {.step = {0.0, 3.0, 3.0, 50.0, 51.0, 99.0, 100.0}, .steps = 7};
    for (int target = 0; target <= 8; target++)
        for (int equal = 0; equal < 2; equal++)
            for (int first = 0; first <= 100; first += 20) {
                double pass = 101.0;
                for (int at = 100; at >= 0; at--) {
                    double value;
                    measure(&s, at, &value);
                    pass = (equal ? value > target : value >= target) ? at : pass;
                }
                s.tried = 0;
                const struct target_bracket b = find(&s, target, equal, first);
                CHECK_NEAR(b.high, pass, 0.0);
                CHECK_NEAR(b.low, pass - 1.0, 0.0);
                assert_int_equal(b.trials, s.tried);
                assert_true(b.trials <= 9);
                assert_true(isnan(b.low_value) == (pass == 0.0));
                assert_true(isnan(b.high_value) == (pass == 101.0));
            }
}

static bool is_close(void *context, const struct target_bracket *b)
{
    (void)context;
    return fabs(b->value - 4.0) < 1.5;
}

static void test_ends(void **state)
{
    (void)state;
    struct stairs s = {.step = {10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0}, .steps = 8};
    struct target_search search = {
        .target = 4.0, .narrow = 1e-9, .most_trials = 5, .measure = measure, .context = &s};
    struct target_bracket b = {.low = 0.0, .high = 100.0, .at = 50.0};
    CHECK_OK(target_search(&b, &search));  // no more trials than are allowed, each in the middle
    assert_int_equal(s.tried, 5);
    CHECK_NEAR(b.high - b.low, 100.0 / 32.0, 1e-9);
    assert_true(b.low <= 40.0 && b.high >= 40.0);

    b = (struct target_bracket){.low = 0.0, .high = 100.0, .at = 99.0};
    search.is_close = is_close;
    s.tried = 0;
    CHECK_OK(target_search(&b, &search));  // 8 is far, 4 is close
    assert_int_equal(b.trials, 2);
    CHECK_NEAR(b.value, 4.0, 0.0);

    b = (struct target_bracket){.low = 0.0, .high = 100.0, .at = 99.0};
    search.is_close = NULL;
    s = (struct stairs){.status = RELUME_ECANCEL};
    assert_int_equal(target_search(&b, &search), RELUME_ECANCEL);
    assert_int_equal(s.tried, 3);
    assert_int_equal(b.trials, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_target),
        cmocka_unit_test(test_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
