// test_bilinear.c - the one bilinear sampler: exact on what is linear, and its two edges
#include "test.h"

#include "core/math/bilinear.h"

enum { WIDTH = 5, HEIGHT = 4 };

// Linear in x and in y, so bilinear values are the function itself.
static double slope(double x, double y, int channel)
{
    return 1.0 + 2.0 * x - 3.0 * y + 0.5 * x * y + 10.0 * channel;
}

static void fill(float data[3 * WIDTH * HEIGHT])
{
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        data[i] = (float)slope(i / 3 % WIDTH, i / 3 / WIDTH, i % 3);
}

static void check(const float *data, double x, double y, enum edge edge, double want, int channel)
{
    const struct bilinear b = bilinear_at(x, y, WIDTH, HEIGHT, edge);
    double sum = 0.0, sumf = 0.0, shares = 0.0;
    for (int k = 0; k < 4; k++) {
        sum += bilinear_share(&b, k, 0.5) * (double)data[3 * b.at[k] + (size_t)channel];
        sumf += (double)(bilinear_sharef(&b, k, 0.5f) * data[3 * b.at[k] + (size_t)channel]);
        shares += bilinear_share(&b, k, 1.0);
    }
    CHECK_NEAR(shares, 1.0, 1e-15);
    CHECK_NEAR(bilinear_value(&b, data, 3, (size_t)channel), want, 1e-13);  // a few roundings
    CHECK_NEAR(bilinear_valuef(&b, data, 3, (size_t)channel), want, 1e-5);  // of values below 40
    CHECK_NEAR(2.0 * sum, want, 1e-13);
    CHECK_NEAR(2.0 * sumf, want, 1e-5);
}

static void test_inside(void **state)
{
    (void)state;
    float data[3 * WIDTH * HEIGHT];
    fill(data);
    for (double y = 0.0; y <= HEIGHT - 1; y += 0.25)
        for (double x = 0.0; x <= WIDTH - 1; x += 0.125)
            for (int c = 0; c < 3; c++)
                for (int edge = EDGE_CLAMPED; edge <= EDGE_WRAPPED; edge++)
                    check(data, x, y, (enum edge)edge, slope(x, y, c), c);
}

static void test_edges(void **state)
{
    (void)state;
    float data[3 * WIDTH * HEIGHT];
    fill(data);
    // half way from the last column to the first, again a turn further on, and far beyond
    const double between = 0.5 * (slope(WIDTH - 1, 1, 0) + slope(0, 1, 0));
    for (int turn = -3; turn <= 3; turn++)
        check(data, WIDTH * turn - 0.5, 1.0, EDGE_WRAPPED, between, 0);
    const double ends[][2] = {{-0.75, 1.0}, {-1e300, 1.0}, {(double)-INFINITY, 1.0}};
    for (int i = 0; i < 2; i++) {
        check(data, ends[i][0], ends[i][1], EDGE_CLAMPED, slope(0, 1, 1), 1);
        check(data, WIDTH - 1 - ends[i][0], HEIGHT + 0.25, EDGE_CLAMPED,
              slope(WIDTH - 1, HEIGHT - 1, 1), 1);
        check(data, 1.0, ends[i][0], EDGE_WRAPPED, slope(1, 0, 1), 1);  // rows never repeat
    }
    // no number is inside too: nothing but what is there may be read
    const struct bilinear b = bilinear_at((double)NAN, ends[2][0], WIDTH, HEIGHT, EDGE_WRAPPED);
    for (int k = 0; k < 4; k++)
        assert_true(b.at[k] < WIDTH * HEIGHT);
}

static void test_spread(void **state)
{
    (void)state;
    for (double y = -0.5; y <= 3.5; y += 0.25)
        for (double x = -0.5; x <= 3.5; x += 0.25) {
            double weights[16] = {0.0}, sum = 0.0;
            bilinear_spread(weights, 4, x, y);
            for (int i = 0; i < 16; i++)
                sum += weights[i] * slope(i % 4, i / 4, 0);
            CHECK_NEAR(sum, slope(x, y, 0), 1e-12);  // the outermost cell goes on
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inside),
        cmocka_unit_test(test_edges),
        cmocka_unit_test(test_spread),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
