// test_ciede2000.c - tests of src/image/compare/ciede2000.h: perceived colour difference (Sharma,
// Wu, Dalal 2005, kL = kC = kH = 1)
#include "test.h"

#include "image/compare/ciede2000.h"

// Sharma, Wu, Dalal 2005, table 1: the pairs that separate right programs from wrong ones.
static const double pairs[34][7] = {
    {50.0000, 2.6772, -79.7751, 50.0000, 0.0000, -82.7485, 2.0425},
    {50.0000, 3.1571, -77.2803, 50.0000, 0.0000, -82.7485, 2.8615},
    {50.0000, 2.8361, -74.0200, 50.0000, 0.0000, -82.7485, 3.4412},
    {50.0000, -1.3802, -84.2814, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, -1.1848, -84.8006, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, -0.9009, -85.5211, 50.0000, 0.0000, -82.7485, 1.0000},
    {50.0000, 0.0000, 0.0000, 50.0000, -1.0000, 2.0000, 2.3669},
    {50.0000, -1.0000, 2.0000, 50.0000, 0.0000, 0.0000, 2.3669},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0009, 7.1792},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0010, 7.1792},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0011, 7.2195},
    {50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0012, 7.2195},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0009, -2.4900, 4.8045},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0010, -2.4900, 4.8045},
    {50.0000, -0.0010, 2.4900, 50.0000, 0.0011, -2.4900, 4.7461},
    {50.0000, 2.5000, 0.0000, 50.0000, 0.0000, -2.5000, 4.3065},
    {50.0000, 2.5000, 0.0000, 73.0000, 25.0000, -18.0000, 27.1492},
    {50.0000, 2.5000, 0.0000, 61.0000, -5.0000, 29.0000, 22.8977},
    {50.0000, 2.5000, 0.0000, 56.0000, -27.0000, -3.0000, 31.9030},
    {50.0000, 2.5000, 0.0000, 58.0000, 24.0000, 15.0000, 19.4535},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.1736, 0.5854, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.2972, 0.0000, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 1.8634, 0.5757, 1.0000},
    {50.0000, 2.5000, 0.0000, 50.0000, 3.2592, 0.3350, 1.0000},
    {60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644},
    {63.0109, -31.0961, -5.8663, 62.8187, -29.7946, -4.0864, 1.2630},
    {61.2901, 3.7196, -5.3901, 61.4292, 2.2480, -4.9620, 1.8731},
    {35.0831, -44.1164, 3.7933, 35.0232, -40.0716, 1.5901, 1.8645},
    {22.7233, 20.0904, -46.6940, 23.0331, 14.9730, -42.5619, 2.0373},
    {36.4612, 47.8580, 18.3852, 36.2715, 50.5065, 21.2231, 1.4146},
    {90.8027, -2.0831, 1.4410, 91.1528, -1.6435, 0.0447, 1.4441},
    {90.9257, -0.5406, -0.9208, 88.6381, -0.8985, -0.7239, 1.5381},
    {6.7747, -0.2908, -2.4247, 5.8714, -0.0985, -2.2286, 0.6377},
    {2.0776, 0.0795, -1.1350, 0.9033, -0.0636, -0.5514, 0.9082},
};

static void test_table(void **state)
{
    (void)state;
    for (int i = 0; i < 34; i++) {
        // the table has four decimals
        CHECK_NEAR(ciede2000(pairs[i], pairs[i] + 3), pairs[i][6], 0.5001e-4);
        CHECK_NEAR(ciede2000(pairs[i] + 3, pairs[i]), pairs[i][6], 0.5001e-4);
    }
}

static void put_lab(struct lab_block *block, int i, const double lab[3])
{
    block->l[i] = lab[0];
    block->a[i] = lab[1];
    block->b[i] = lab[2];
}

// The block against the paper's own words, for its pairs, for opposite hues and for near and far
// random ones. Single precision after the differences: a few 2^-24 of each term, and the table of
// the blue turn is within 1e-6.
static void test_block(void **state)
{
    (void)state;
    static struct lab_block one, two;
    float got[CIEDE_BLOCK];
    uint32_t seed = 3;
    double sum[2] = {0.0, 0.0};
    for (int round = 0; round < 400; round++) {
        double lab[CIEDE_BLOCK][2][3];
        for (int i = 0; i < CIEDE_BLOCK; i++) {
            const double apart = pow(10.0, -3.0 * test_uniform(&seed));
            for (int c = 0; c < 3; c++) {
                const double centre = c ? 0.0 : 50.0, extent = c ? 90.0 : 50.0;
                lab[i][0][c] = centre + extent * (2.0 * test_uniform(&seed) - 1.0);
                lab[i][1][c] = lab[i][0][c] + extent * apart * (2.0 * test_uniform(&seed) - 1.0);
            }
            if (round == 0 && i < 34)
                memcpy(lab[i], pairs[i], sizeof lab[i]);
            if (round == 1)  // exactly and nearly opposite
                for (int c = 1; c < 3; c++)
                    lab[i][1][c] = -0.7 * lab[i][0][c] + (c == 1 ? 1e-3 * (i - 64) : 0.0);
            if (round == 2)  // greys
                lab[i][i % 2][1] = lab[i][i % 2][2] = 0.0;
            put_lab(&one, i, lab[i][0]);
            put_lab(&two, i, lab[i][1]);
        }
        ciede2000_block(ciede_tables(), &one, &two, got);
        for (int i = 0; i < CIEDE_BLOCK; i++) {
            const double want = ciede2000(lab[i][0], lab[i][1]);
            CHECK_NEAR((double)got[i], want, 1e-5 * want + 1e-7);
            sum[0] += (double)got[i];
            sum[1] += want;
        }
    }
    CHECK_NEAR(sum[0], sum[1], 1e-7 * sum[1]);  // errors have no preferred sign
    ciede2000_block(ciede_tables(), &one, &one, got);
    for (int i = 0; i < CIEDE_BLOCK; i++)
        CHECK_NEAR((double)got[i], 0.0, 0.0);
}

static void test_lab(void **state)
{
    (void)state;
    const float rgb[3][3] = {{0, 0, 0}, {1, 1, 1}, {1, 0, 0}};
    // the white point of the matrix is D65 to five digits; red as the standard's primaries give it
    const double want[3][3] = {{0, 0, 0}, {100, 0, 0}, {53.2408, 80.0925, 67.2032}};
    static struct lab_block lab;
    lab_from_linear(ciede_tables(), &lab, rgb[0], 3);
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR(lab.l[i], want[i][0], 1e-4);
        CHECK_NEAR(lab.a[i], want[i][1], 1e-2);
        CHECK_NEAR(lab.b[i], want[i][2], 1e-2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_table), cmocka_unit_test(test_block),
                                       cmocka_unit_test(test_lab)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
