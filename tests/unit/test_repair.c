// test_repair.c - tests of src/capture/manifest/repair.h: pixels that hold NaN or infinity
#include "test.h"

#include "capture/manifest/repair.h"

enum { LIGHTS = 5, PIXELS = 3 };

static const vec3 lights[LIGHTS] = {
    {0, 0, 1}, {0.6, 0, 0.8}, {-0.8, 0, 0.6}, {0, 1, 0}, {0, -0.28, 0.96}};

static void fill(float out[LIGHTS][PIXELS][3])
{
    for (int i = 0; i < LIGHTS; i++)
        for (int x = 0; x < PIXELS; x++)
            for (int c = 0; c < 3; c++)
                out[i][x][c] = (float)(100 * i + 10 * x + c);
}

static void run(float out[LIGHTS][PIXELS][3])
{
    size_t broken[LIGHTS];
    bool whole[LIGHTS];
    for (int i = 0; i < LIGHTS; i++)
        broken[i] = repair_count(out[i][0], PIXELS);
    repair_band(out[0][0], broken, lights, LIGHTS, PIXELS, whole);
}

static void test_count(void **state)
{
    (void)state;
    float out[LIGHTS][PIXELS][3];
    fill(out);
    assert_int_equal(repair_count(out[0][0], LIGHTS * PIXELS), 0);
    out[0][1][2] = NAN;
    out[0][1][0] = NAN;  // a pixel counts once
    out[3][0][1] = INFINITY;
    out[4][2][0] = -INFINITY;
    assert_int_equal(repair_count(out[0][0], LIGHTS * PIXELS), 3);
}

// The three nearest of light 0 lie 0.2838 (4), 0.6435 (1) and 0.9273 (2) radians away.
static void test_weights(void **state)
{
    (void)state;
    float out[LIGHTS][PIXELS][3], want[LIGHTS][PIXELS][3];
    fill(out);
    fill(want);
    const double a[3] = {1.0 / asin(0.28), 1.0 / asin(0.6), 1.0 / asin(0.8)};
    const double sum = a[0] + a[1] + a[2];
    out[0][1][2] = NAN;
    for (int c = 0; c < 3; c++)  // the whole pixel
        want[0][1][c] = (float)((a[0] * 410 + a[1] * 110 + a[2] * 210) / sum + c);
    run(out);
    for (int i = 0; i < LIGHTS; i++)
        for (int x = 0; x < PIXELS; x++)
            for (int c = 0; c < 3; c++)
                CHECK_NEAR((double)out[i][x][c], (double)want[i][x][c], 1e-4);
}

// What was repaired helps nobody, and where nothing is whole there is black.
static void test_few_donors(void **state)
{
    (void)state;
    float out[LIGHTS][PIXELS][3];
    fill(out);
    for (int i = 0; i < LIGHTS; i++)
        out[i][2][0] = NAN;
    for (int i = 0; i < LIGHTS - 1; i++)
        out[i][0][1] = INFINITY;
    run(out);
    for (int i = 0; i < LIGHTS; i++)
        for (int c = 0; c < 3; c++) {
            CHECK_NEAR((double)out[i][0][c], 400.0 + c, 1e-4);
            CHECK_NEAR((double)out[i][1][c], 100.0 * i + 10.0 + c, 0.0);
            CHECK_NEAR((double)out[i][2][c], 0.0, 0.0);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_count),
        cmocka_unit_test(test_weights),
        cmocka_unit_test(test_few_donors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
