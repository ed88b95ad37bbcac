// test_budget.c - which items leave when they take more memory than they may
#include "test.h"

#include "core/base/budget.h"

enum { ITEMS = 4 };

static void the_least_recently_used_leaves(void **state)
{
    (void)state;
    struct budget b;
    assert_true(budget_create(&b, ITEMS, 100));
    for (int i = 0; i < ITEMS; i++) {
        b.round = 10 - (uint64_t)i;
        budget_use(&b, i);
        budget_set(&b, i, 30);
    }
    b.round = 11;
    assert_int_equal(b.bytes, 120);
    assert_int_equal(budget_excess(&b, 0), 3);
    budget_use(&b, 3);
    assert_int_equal(budget_excess(&b, 0), 2);
    budget_forget(&b, 2);
    assert_int_equal(b.bytes, 90);
    assert_int_equal(budget_excess(&b, 0), -1);
    assert_int_equal(budget_excess(&b, 10), -1);
    assert_int_equal(budget_excess(&b, 11), 1);
    budget_destroy(&b);
}

static void what_is_in_use_stays(void **state)
{
    (void)state;
    struct budget b;
    assert_true(budget_create(&b, ITEMS, 1));
    b.round = 1;
    assert_int_equal(budget_excess(&b, 1000), -1);  // nothing is held
    for (int i = 0; i < ITEMS; i++) {
        budget_set(&b, i, 5);
        budget_use(&b, i);
    }
    assert_int_equal(budget_excess(&b, 0), -1);
    b.round = 2;
    assert_int_equal(budget_excess(&b, 0), 0);  // of equally old ones the first
    budget_destroy(&b);
}

// Items that were read ahead and never used leave before all others.
static void the_never_used_leaves_first(void **state)
{
    (void)state;
    struct budget b;
    assert_true(budget_create(&b, ITEMS, 10));
    b.round = 1;
    budget_set(&b, 0, 8);
    budget_use(&b, 0);
    budget_set(&b, 2, 8);
    b.round = 2;
    assert_int_equal(budget_excess(&b, 0), 2);
    budget_set(&b, 2, 3);  // grows and shrinks
    assert_int_equal(b.bytes, 11);
    budget_set(&b, 2, 2);
    assert_int_equal(budget_excess(&b, 0), -1);
    budget_set(&b, 0, 0);
    budget_set(&b, 0, 9);
    assert_int_equal(b.item[0].used, 1);
    budget_forget(&b, 0);
    assert_int_equal(b.item[0].used, 0);
    assert_int_equal(b.bytes, 2);
    budget_destroy(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_least_recently_used_leaves),
        cmocka_unit_test(what_is_in_use_stays),
        cmocka_unit_test(the_never_used_leaves_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
