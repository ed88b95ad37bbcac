// Haar wavelets: energy stays, the way back is exact, and what is kept is the best that so few say.
#include "test.h"

#include "core/math/haar.h"
#include "core/math/random.h"

static double squares(const float *v, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += (double)v[i] * (double)v[i];
    return sum;
}

// Parseval, and there and back, at every size and with values apart.
static void energy_stays(void **state)
{
    (void)state;
    struct random random = random_stream(1, 2, 3);
    for (int side = 1; side <= 32; side *= 2) {
        float data[3 * 32 * 32], before[3 * 32 * 32];
        const int n = 3 * side * side;
        for (int i = 0; i < n; i++)
            before[i] = data[i] = (float)random_range(&random, -1, 1);
        for (size_t c = 0; c < 3; c++)
            haar_square(data + c, side, 3, false);
        CHECK_NEAR(squares(data, n), squares(before, n), 1e-5 * n);
        for (size_t c = 0; c < 3; c++)
            haar_square(data + c, side, 3, true);
        for (int i = 0; i < n; i++)
            CHECK_NEAR(data[i], before[i], 1e-5);
    }
}

// A constant is one number; a pair of halves two (Stollnitz, DeRose, Salesin 1995).
static void few_functions_say_simple_things(void **state)
{
    (void)state;
    float even[64], halves[64];
    for (int i = 0; i < 64; i++) {
        even[i] = 0.5f;
        halves[i] = i % 8 < 4 ? 1.0f : 0.0f;
    }
    haar_square(even, 8, 1, false);
    haar_square(halves, 8, 1, false);
    CHECK_NEAR(even[0], 4.0, 1e-6);  // 0.5 times the root of 64
    CHECK_NEAR(halves[0], 4.0, 1e-6);
    CHECK_NEAR(halves[1], 4.0, 1e-6);
    for (int i = 1; i < 64; i++) {
        CHECK_NEAR(even[i], 0.0, 1e-6);
        CHECK_NEAR(halves[i], i == 1 ? 4.0 : 0.0, 1e-6);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_stays),
        cmocka_unit_test(few_functions_say_simple_things),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
