// cmocka.h - as much of cmocka as tests/kernels use, where there is no cmocka for the processor;
// the first failure ends the program
#ifndef SMALL_CMOCKA_H
#define SMALL_CMOCKA_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct CMUnitTest {
    const char *name;
    void (*run)(void **state);
};
#define cmocka_unit_test(function)                                                                 \
    {                                                                                              \
#function, function                                                                        \
    }

#define print_message(...)              printf(__VA_ARGS__)
#define print_error(...)                printf(__VA_ARGS__)
#define fail_msg(...)                   (printf(__VA_ARGS__), _fail(__FILE__, __LINE__))
#define assert_true(what)               ((what) ? (void)0 : _fail(#what " is false: " __FILE__, __LINE__))
#define assert_int_equal(a, b)          assert_true((long long)(a) == (long long)(b))
#define assert_ptr_equal(a, b)          assert_true((const void *)(a) == (const void *)(b))
#define assert_non_null(a)              assert_true((a) != NULL)
#define assert_string_equal(a, b)       assert_true(strcmp((a), (b)) == 0)
#define assert_memory_equal(a, b, size) assert_true(memcmp((a), (b), (size)) == 0)

static inline void _fail(const char *file, int line)
{
    printf("%s:%d: failed\n", file, line);
    exit(1);
}

static inline int run_all(const struct CMUnitTest *tests, size_t n, int (*before)(void **state))
{
    if (before)
        before(NULL);
    for (size_t i = 0; i < n; i++) {
        tests[i].run(NULL);
        printf("[       OK ] %s\n", tests[i].name);
    }
    return 0;
}
#define cmocka_run_group_tests(tests, before, after)                                               \
    run_all((tests), sizeof(tests) / sizeof *(tests), (before))

#endif
