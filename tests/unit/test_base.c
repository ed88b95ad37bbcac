// What everything stands on: whole numbers of any value
#include "test.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_whole)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
