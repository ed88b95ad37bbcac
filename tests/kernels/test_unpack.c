// test_unpack.c - bytes to planes and waiting numbers to codes: every instruction set gives the
// bits of plain C, which divides and rounds as IEEE says
#include "sets.h"

enum { MOST = 600 };

static void test_thirds(void **state)
{
    (void)state;
    static uint8_t in[3 * MOST + 1];
    float out[3][MOST + 1];
    for (int i = 0; i < 3 * MOST; i++)
        in[i + 1] = (uint8_t)(i * 7 + i / 256);
    for (int s = 0; sets[s]; s++)
        for (size_t n = 0; n <= MOST; n += n < 40 ? 1 : 280) {
            for (int c = 0; c < 3; c++)
                out[c][n] = 42.0f;
            sets[s]->unpack->thirds(in + 1, n, out[0], out[1], out[2]);
            for (int c = 0; c < 3; c++) {
                for (size_t i = 0; i < n; i++)
                    assert_true(out[c][i] == (float)in[1 + 3 * i + (size_t)c] / 255.0f);
                assert_true(out[c][n] == 42.0f);  // nothing behind the end
            }
        }
}

static void test_codes(void **state)
{
    (void)state;
    static const float pairs[][2] = {{0.0039f, 0.5f}, {0.02f, -300.0f}, {-0.004f, 255.9f},
                                     {0.0f, 7.5f},    {1e30f, 0.0f},    {1e-30f, -1e-30f}};
    static uint16_t in[MOST + 1];
    uint8_t out[MOST + 1];
    uint32_t seed = 3;
    for (int i = 0; i <= MOST; i++)
        in[i] = (uint16_t)(i < 4 ? 65535 * (i % 2) : (int)test_random(&seed));
    for (int s = 0; sets[s]; s++)
        for (size_t p = 0; p < sizeof pairs / sizeof *pairs; p++)
            for (size_t n = 0; n <= MOST; n += n < 70 ? 1 : 265) {
                out[n] = 42;
                sets[s]->unpack->codes(in + 1, n, pairs[p][0], pairs[p][1], out);
                for (size_t i = 0; i < n; i++) {
                    const volatile float product = (float)in[i + 1] * pairs[p][0];
                    const float v = product + pairs[p][1];
                    assert_int_equal(out[i], v < 0.0f ? 0 : v > 255.0f ? 255 : (int)v);
                }
                assert_int_equal(out[n], 42);
            }
}

static void test_words(void **state)
{
    (void)state;
    static float in[MOST + 1];
    uint16_t out[MOST + 1], want[MOST];
    uint32_t seed = 5;
    for (int i = 0; i <= MOST; i++)
        in[i] = -3.0f + 7.0f * test_uniform(&seed);
    in[3] = NAN;
    in[40] = -4.0f;  // below the least
    for (int s = 0; sets[s]; s++)
        for (size_t n = 0; n <= MOST; n += n < 70 ? 1 : 265) {
            out[n] = 42;
            sets[s]->unpack->words(in + 1, n, -3.0f, 65535.0f / 7.0f, out);
            words_c(in + 1, n, -3.0f, 65535.0f / 7.0f, want);
            assert_memory_equal(out, want, n * sizeof *out);
            assert_int_equal(out[n], 42);
        }
    assert_int_equal(want[2], 0);
    assert_int_equal(want[39], 0);
}

static void test_range(void **state)
{
    (void)state;
    static float in[MOST + 1];
    uint32_t seed = 6;
    for (int i = 0; i <= MOST; i++)
        in[i] = -3.0f + 7.0f * test_uniform(&seed);
    in[2] = NAN;
    for (int s = 0; sets[s]; s++)
        for (size_t n = 0; n <= MOST; n += n < 70 ? 1 : 265)
            for (size_t at = 0; at < n; at += n < 70 ? 1 : 7) {  // the extremes at every place
                float min = 0.5f, max = 0.25f;
                const float kept = in[at];
                in[at] = at % 2 ? -9.0f : 9.0f;
                sets[s]->unpack->range(in, n, &min, &max);
                assert_true(at % 2 ? min == -9.0f && max < 4.0f : max == 9.0f && min >= -3.0f);
                in[at] = kept;
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_thirds),
        cmocka_unit_test(test_codes),
        cmocka_unit_test(test_words),
        cmocka_unit_test(test_range),
    };
    return cmocka_run_group_tests(tests, find_sets, NULL);
}
