// test_functions.c - learned functions as text: how near they are, how few bytes they take, and
// what earlier files have
#include "test.h"

#include "format/pack/functions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COMPONENTS = 5, EACH = 40, NUMBERS = 3 * COMPONENTS * EACH };

// Greys nearly: green and blue are parts of red, and a little of their own.
static void make(float *numbers)
{
    for (int i = 0; i < NUMBERS; i++) {
        const int c = i / (COMPONENTS * EACH), at = i % (COMPONENTS * EACH);
        numbers[i] = (1.0f - 0.3f * (float)c) * sinf(1.7f * (float)(at * at)) +
                     0.02f * (float)c * cosf((float)(at * at));
    }
}

// Products with coefficients of the largest size are off by half of what is allowed at most, of
// coefficients that are 0 by anything; and half as fine a step is a bit less for each number.
static void test_bound(void **state)
{
    const float most[COMPONENTS] = {0.5f, 0.1f, 0.0f, 3e-4f, 1e-3f};
    float numbers[NUMBERS], back[NUMBERS];
    size_t length[3];
    (void)state;
    make(numbers);
    for (int i = 0; i < 3; i++) {
        const double allowed = 0.001 * (1 << i);
        char *text = functions_text(numbers, COMPONENTS, EACH, most, allowed);
        assert_non_null(text);
        length[i] = strlen(text);
        CHECK_OK(functions_of_text(back, text, COMPONENTS, EACH));
        for (int k = 0; k < NUMBERS; k++)
            CHECK_NEAR(back[k] * most[k / EACH % COMPONENTS],
                       numbers[k] * most[k / EACH % COMPONENTS], 0.501 * allowed);
        free(text);
    }
    // two digits for a number before
    assert_true(length[0] < NUMBERS);
    assert_true(length[1] < length[0] && length[2] < length[1]);
}

// Numbers that are the same in all channels cost little more than those of one.
static void test_channels_are_foretold(void **state)
{
    const float most[COMPONENTS] = {1, 1, 1, 1, 1};
    float numbers[NUMBERS];
    (void)state;
    for (int i = 0; i < NUMBERS; i++)
        numbers[i] = sinf(1.7f * (float)(i * i));
    char *own = functions_text(numbers, COMPONENTS, EACH, most, 0.001);
    for (int c = 1; c < 3; c++)
        memcpy(numbers + (size_t)c * COMPONENTS * EACH, numbers,
               COMPONENTS * EACH * sizeof *numbers);
    char *same = functions_text(numbers, COMPONENTS, EACH, most, 0.001);
    assert_true(own && same && 2 * strlen(same) < strlen(own));
    free(own);
    free(same);
}

static void test_edges(void **state)
{
    const float most[1] = {1.0f};
    const float wide[3] = {1e6f, 1e-6f, -1e6f}, none[3] = {0.0f, 0.0f, 0.0f};
    float back[3];
    (void)state;
    char *text = functions_text(wide, 1, 1, most, 1e-6);  // as fine as 32767 steps are
    assert_non_null(text);
    CHECK_OK(functions_of_text(back, text, 1, 1));
    CHECK_NEAR(back[0], 1e6, 32.0);
    CHECK_NEAR(back[1], 0.0, 32.0);
    CHECK_NEAR(back[2], -1e6, 32.0);
    free(text);
    text = functions_text(none, 1, 1, most, 1e-6);
    assert_non_null(text);
    CHECK_OK(functions_of_text(back, text, 1, 1));
    assert_true(back[0] == 0.0f && back[1] == 0.0f && back[2] == 0.0f);
    free(text);
}

// Whatever the digits are, numbers are finite; what is no digit is damage.
static void test_damage(void **state)
{
    float back[NUMBERS];
    char text[200];
    (void)state;
    assert_int_equal(functions_of_text(back, "", 1, 1), RELUME_EDAMAGED);
    assert_int_equal(functions_of_text(back, "AAAA", COMPONENTS, EACH), RELUME_EDAMAGED);
    assert_int_equal(functions_of_text(back, "AAAAA*", COMPONENTS, EACH), RELUME_EDAMAGED);
    assert_int_equal(functions_of_text(back, "AA-AA", COMPONENTS, EACH), RELUME_EDAMAGED);
    for (unsigned seed = 1; seed <= 20; seed++) {
        unsigned n = seed;
        for (size_t i = 0; i + 1 < sizeof text; i++) {
            n = n * 1664525u + 1013904223u;
            text[i] = "AZaz09+/"[n >> 29];
        }
        text[sizeof text - 1] = 0;
        CHECK_OK(functions_of_text(back, text, COMPONENTS, EACH));
        for (int k = 0; k < NUMBERS; k++)
            assert_true(isfinite(back[k]));
    }
}

// 0.7 x (64 a + b - 2048) / 2047, as files had them before.
static void test_two_digits(void **state)
{
    const float most[2] = {0.7f, 2.0f};
    float back[4];
    (void)state;
    assert_true(functions_of_digits(back, "gA//gAAB", most, 2, 2));
    CHECK_NEAR(back[0], 0.0, 0.0);
    CHECK_NEAR(back[1], 0.7, 1e-6);
    CHECK_NEAR(back[2], 0.0, 0.0);
    CHECK_NEAR(back[3], -2.0, 1e-6);
    assert_false(functions_of_digits(back, "gA//g-AB", most, 2, 2));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bound),      cmocka_unit_test(test_channels_are_foretold),
        cmocka_unit_test(test_edges),      cmocka_unit_test(test_damage),
        cmocka_unit_test(test_two_digits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
