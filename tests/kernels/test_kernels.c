// test_kernels.c - every instruction set against plain C; `--bench` prints nanoseconds a code
#include "sets.h"

#include "core/base/half.h"

#include <time.h>

enum { MOST = 3000, PLANES = 9, KINDS = 4 };

static uint8_t bytes[PLANES][MOST + 64];
static uint16_t words[PLANES][MOST + 64], halves[PLANES][MOST + 64];
static float floats[PLANES][MOST + 64];

struct pattern {
    const char *name;
    float weight, bias;
    uint32_t mask;  // of the codes
};
static const struct pattern patterns[] = {
    {"ordinary", 1.0f, 0.5f, 0xffff}, {"huge", 1e30f, -1e30f, 0xffff},
    {"tiny", 1e-38f, 1e-40f, 0xffff}, {"zero", 0.0f, 0.0f, 0xffff},
    {"dark", 1.0f, 0.0f, 0x0003},
};

static void fill(const struct pattern *p, float *weights)
{
    uint32_t seed = 5;
    for (int k = 0; k < PLANES; k++) {
        weights[k] = p->weight * (float)(2.0 * test_uniform(&seed) - 1.0);
        for (int i = 0; i < MOST + 64; i++) {
            const uint32_t r = test_random(&seed) & p->mask;
            bytes[k][i] = (uint8_t)r;
            words[k][i] = (uint16_t)r;
            halves[k][i] = (uint16_t)(r & 0xfbff);  // finite
            floats[k][i] = ((float)r - 3e4f) * 1.7f;
        }
    }
}

static double code(int kind, int k, size_t i)
{
    return kind == 0   ? bytes[k][i]
           : kind == 1 ? words[k][i]
           : kind == 2 ? (double)float_from_half(halves[k][i])
                       : (double)floats[k][i];
}

static void run(const struct kernels *kernels, int kind, size_t offset, size_t n, float bias,
                const float *weights, int count, float *out)
{
    const uint8_t *b[PLANES];
    const uint16_t *w[PLANES];
    const float *f[PLANES];
    for (int k = 0; k < count; k++) {
        b[k] = bytes[k] + offset;
        f[k] = floats[k] + offset;
        w[k] = (kind == 1 ? words[k] : halves[k]) + offset;
    }
    if (kind == 0)
        kernels->dot->bytes(out, n, bias, b, weights, count);
    else if (kind == 1)
        kernels->dot->words(out, n, bias, w, weights, count);
    else if (kind == 2)
        kernels->dot->halves(out, n, bias, w, weights, count);
    else
        kernels->dot->floats(out, n, bias, f, weights, count);
}

// Both against double precision: each of the `count` additions rounds once, at most 2^-24 of the
// running sum's bound; FMA rounds less.
static void check(const struct kernels *kernels, const struct pattern *p, int kind, size_t offset,
                  size_t n, int count)
{
    static float out[MOST + 1];
    float weights[PLANES];
    fill(p, weights);
    out[n] = 42.0f;
    run(kernels, kind, offset, n, p->bias, weights, count, out);
    assert_true(out[n] == 42.0f);  // nothing behind the end
    for (size_t i = 0; i < n; i++) {
        double want = (double)p->bias, bound = fabs(want);
        for (int k = 0; k < count; k++) {
            const double term = (double)weights[k] * code(kind, k, offset + i);
            want += term;
            bound += fabs(term);
        }
        const double tolerance = 0x1p-24 * 2.0 * (count + 1) * bound + 1e-44 * (count + 1);
        if (!(fabs((double)out[i] - want) <= tolerance))
            fail_msg("%s, %s, kind %d, offset %zu, n %zu, %d planes: [%zu] is %.9g, expected %.9g",
                     kernels->name, p->name, kind, offset, n, count, i, (double)out[i], want);
    }
}

static void test_tails(void **state)
{
    (void)state;
    for (int s = 0; sets[s]; s++)
        for (int kind = 0; kind < KINDS; kind++)
            for (size_t n = 0; n <= 150; n += n < 40 ? 1 : 13)
                for (int count = 0; count <= PLANES; count += 3)
                    check(sets[s], &patterns[0], kind, n % 5, n, count);
}

static void test_patterns(void **state)
{
    (void)state;
    for (int s = 0; sets[s]; s++)
        for (int kind = 0; kind < KINDS; kind++)
            for (size_t p = 0; p < sizeof patterns / sizeof *patterns; p++)
                for (int count = 1; count <= PLANES; count++)
                    check(sets[s], &patterns[p], kind, (size_t)count, 333, count);
}

// Every length and alignment of the streaming loop's head and tail; nothing behind the end.
static void test_look_up(void **state)
{
    (void)state;
    enum { CODES = 65536, LONGEST = 70 };
    static uint32_t table[CODES], out[LONGEST + 20];
    static uint16_t index[LONGEST + 20];
    for (uint32_t i = 0; i < CODES; i++)
        table[i] = i * 2654435761u;
    for (uint32_t i = 0; i < LONGEST + 20; i++)
        index[i] = (uint16_t)(i * 40503u + (i % 7 ? 0 : 65535));
    for (int s = 0; sets[s]; s++)
        for (size_t from = 0; from < 16; from++)
            for (size_t n = 0; n <= LONGEST; n++) {
                memset(out, 0xa5, sizeof out);
                sets[s]->look_up(out + from, n, index + from / 2, table);
                for (size_t i = 0; i < LONGEST + 20; i++) {
                    const bool inside = i >= from && i < from + n;
                    const uint32_t want = inside ? table[index[i - from + from / 2]] : 0xa5a5a5a5u;
                    if (out[i] != want)
                        fail_msg("%s: from %zu, n %zu: [%zu] is %x, expected %x", sets[s]->name,
                                 from, n, i, out[i], want);
                }
            }
}

static void test_choice(void **state)
{
    (void)state;
    assert_ptr_equal(kernels_choose(~0u)->dot, &dot_c);
    assert_ptr_equal(kernels_choose(RELUME_CPU_AVX2 | RELUME_CPU_NEON)->dot, &dot_c);
    assert_string_equal(kernels_choose(~0u)->name, "plain");
    for (int s = 0; sets[s]; s++) {
        setenv("RELUME_CPU", sets[s]->name, 1);
        assert_ptr_equal(kernels_choose(0), sets[s]);
    }
    unsetenv("RELUME_CPU");
}

// All sets but plain C fuse each product with its sum: equal bits.
static void test_equal_bits(void **state)
{
    (void)state;
    static float want[MOST], got[MOST];
    float weights[PLANES];
    for (size_t p = 0; p < sizeof patterns / sizeof *patterns; p++)
        for (int kind = 0; kind < KINDS; kind++) {
            fill(&patterns[p], weights);
            for (size_t i = 0; i < 333; i++) {
                want[i] = patterns[p].bias;
                for (int k = 0; k < PLANES; k++)
                    want[i] = fmaf(weights[k], (float)code(kind, k, i), want[i]);
            }
            for (int s = 1; sets[s]; s++) {
                run(sets[s], kind, 0, 333, patterns[p].bias, weights, PLANES, got);
                assert_memory_equal(got, want, 333 * sizeof *got);
            }
        }
}

// A pixel's bits must not depend on where the run of pixels begins or ends.
static void test_chunks(void **state)
{
    (void)state;
    static float whole[MOST], part[MOST];
    float weights[PLANES];
    fill(&patterns[0], weights);
    for (int s = 0; sets[s]; s++)
        for (int kind = 0; kind < KINDS; kind++) {
            run(sets[s], kind, 0, 500, 0.25f, weights, PLANES, whole);
            for (size_t from = 0; from < 70; from += 3)
                for (size_t n = 1; n < 150; n += 7) {
                    run(sets[s], kind, from, n, 0.25f, weights, PLANES, part);
                    assert_memory_equal(part, whole + from, n * sizeof *part);
                }
        }
}

static double now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void bench(void)
{
    enum { RUNS = 401, N = 2048 };
    static const char *const kinds[] = {"bytes", "words", "halves", "floats"};
    static float out[N];
    float weights[PLANES];
    double ns[RUNS];
    fill(&patterns[0], weights);
    for (int s = 0; sets[s]; s++)
        for (int kind = 0; kind < KINDS; kind++) {
            for (int i = 0; i < RUNS; i++) {
                const double start = now_ns();
                run(sets[s], kind, 0, N, 0.0f, weights, PLANES, out);
                ns[i] = (now_ns() - start) / N / PLANES;
            }
            qsort(ns, RUNS, sizeof *ns, by_value);
            printf("%-6s %-7s %.4f ns a code (quartiles %.4f to %.4f)\n", sets[s]->name,
                   kinds[kind], ns[RUNS / 2], ns[RUNS / 4], ns[3 * RUNS / 4]);
        }
}

int main(int argc, char **argv)
{
    if (argc > 1 && !strcmp(argv[1], "--bench")) {
        find_sets(NULL);
        bench();
        return 0;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tails),   cmocka_unit_test(test_patterns),
        cmocka_unit_test(test_look_up), cmocka_unit_test(test_choice),
        cmocka_unit_test(test_chunks),  cmocka_unit_test(test_equal_bits),
    };
    return cmocka_run_group_tests(tests, find_sets, NULL);
}
