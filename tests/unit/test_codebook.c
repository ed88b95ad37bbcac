// test_codebook.c - training and search against brute force in double precision
#include "test.h"

#include "core/base/memory.h"
#include "format/codebook/books.h"

static float *uniform(size_t floats, uint32_t seed)
{
    float *v = malloc(floats * sizeof *v);
    for (size_t i = 0; i < floats; i++)
        v[i] = (float)(2.0 * test_uniform(&seed) - 1.0);
    return v;
}

// Clusters around a few points, so that cells differ in size and error.
static float *clusters(size_t n, int dim, uint32_t seed)
{
    float *v = uniform(n * (size_t)dim, seed);
    for (size_t i = 0; i < n * (size_t)dim; i++)
        v[i] = 0.1f * v[i] + (float)((i / (size_t)dim % 7) * (i % (size_t)dim % 3));
    return v;
}

static double distance(const float *a, const float *b, int dim)
{
    double sum = 0.0;
    for (int i = 0; i < dim; i++)
        sum += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
    return sum;
}

static int nearest(const float *codes, int count, const float *v, int dim, double *best)
{
    int found = 0;
    *best = INFINITY;
    for (int c = 0; c < count; c++) {
        const double d = distance(codes + (size_t)c * (size_t)dim, v, dim);
        if (d < *best) {
            *best = d;
            found = c;
        }
    }
    return found;
}

static relume_codebook *train(const float *v, size_t n, int dim,
                              const struct relume_codebook_params *p)
{
    relume_codebook *book;
    CHECK_OK(relume_codebook_train(&book, v, n, dim, p));
    assert_int_equal(relume_codebook_info(book)->dim, dim);
    return book;
}

// The slow algorithm of the header, word by word; returns the squared error of the last round.
static double slow_rounds(const float *v, size_t n, int dim, float *codes, int count, int rounds)
{
    int *index = malloc(n * sizeof *index);
    double total = 0.0;
    for (int r = 0; r < rounds; r++) {
        total = 0.0;
        for (size_t i = 0; i < n; i++) {
            double d;
            index[i] = nearest(codes, count, v + i * (size_t)dim, dim, &d);
            total += d;
        }
        for (int c = 0; c < count; c++)
            for (int k = 0; k < dim; k++) {
                double sum = 0.0, members = 0.0;
                for (size_t i = 0; i < n; i++)
                    if (index[i] == c) {
                        sum += (double)v[i * (size_t)dim + (size_t)k];
                        members += 1.0;
                    }
                assert_true(members > 0.0);
                codes[c * dim + k] = (float)(sum / members);
            }
    }
    free(index);
    return total;
}

// Sums of the same order: equal bits, round by round.
static void test_rounds_are_lloyds(void **state)
{
    (void)state;
    enum { N = 700, CODES = 13 };
    static const int dims[] = {1, 2, 3, 17, 75};
    int compared = 0;
    for (size_t d = 0; d < sizeof dims / sizeof *dims; d++)
        for (int rounds = 1; rounds < 12; rounds += 5) {
            const int dim = dims[d];
            float *v = clusters(N, dim, 3), *codes = malloc((size_t)(CODES * dim) * sizeof *codes);
            for (int c = 0; c < CODES; c++)
                memcpy(codes + c * dim, v + c * 31 * dim, (size_t)dim * sizeof *codes);
            relume_codebook *book =
                train(v, N, dim,
                      relume_codebook_params(.codes = CODES, .initial = codes, .max_rounds = rounds,
                                             .min_gain = -1.0));
            const struct relume_codebook_info *info = relume_codebook_info(book);
            if (!info->moved && info->rounds == rounds) {
                const double error = slow_rounds(v, N, dim, codes, CODES, rounds);
                CHECK_NEAR(info->squared_error, error, 1e-12 * error);
                assert_memory_equal(info->vectors, codes, (size_t)(CODES * dim) * sizeof *codes);
                compared++;
            }
            relume_codebook_destroy(&book);
            free(v);
            free(codes);
        }
    assert_true(compared >= 10);
}

static void test_error_never_rises(void **state)
{
    (void)state;
    enum { N = 3000, DIM = 9 };
    float *v = uniform((size_t)N * DIM, 5);
    for (int start = RELUME_START_RANDOM; start <= RELUME_START_SPLIT; start++) {
        double before = INFINITY;
        for (int rounds = 1; rounds <= 30; rounds++) {
            relume_codebook *book = train(
                v, N, DIM,
                relume_codebook_params(.codes = 40, .start = (enum relume_codebook_start)start,
                                       .seed = 2, .max_rounds = rounds, .min_gain = -1.0));
            const double error = relume_codebook_info(book)->squared_error;
            assert_true(error <= before * (1.0 + 1e-12));
            before = error;
            relume_codebook_destroy(&book);
        }
    }
    free(v);
}

static void check_assignment(const relume_codebook *book, const float *v, size_t n, unsigned off)
{
    const struct relume_codebook_info *info = relume_codebook_info(book);
    uint16_t *index = malloc(n * sizeof *index);
    double sum = 0.0, error;
    CHECK_OK(relume_codebook_assign(book, v, n, index, &error,
                                    relume_codebook_assign_params(.cpu_off = off)));
    for (size_t i = 0; i < n; i++) {
        double d;
        const float *vector = v + i * (size_t)info->dim;
        assert_int_equal(index[i], nearest(info->vectors, info->codes, vector, info->dim, &d));
        sum += d;
    }
    CHECK_NEAR(error, sum, 1e-12 * sum);
    free(index);
}

// A book of exactly these codes: no round moves a code that is its only vector.
static relume_codebook *book_of(const float *codes, int count, int dim)
{
    return train(codes, (size_t)count, dim,
                 relume_codebook_params(.codes = count, .initial = codes, .max_rounds = 1));
}

static void test_assignment_is_exact(void **state)
{
    (void)state;
    static const struct {
        int codes, dim;
        float scale, shift;
    } cases[] = {{1, 1, 1, 0},        {2, 1, 1, 1000},  {3, 5, 1e-30f, 0}, {255, 18, 1, 0},
                 {256, 27, 1e15f, 0}, {301, 75, 1, 50}, {64, 2, 1e30f, 0}, {100, 3, 1e-3f, 1e4f}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        const size_t floats = (size_t)cases[c].codes * (size_t)cases[c].dim;
        const size_t n = 500;
        float *codes = uniform(floats, 7), *v = uniform(n * (size_t)cases[c].dim, 8);
        for (size_t i = 0; i < floats; i++)
            codes[i] = cases[c].scale * codes[i] + cases[c].shift;
        for (size_t i = 0; i < n * (size_t)cases[c].dim; i++)
            v[i] = cases[c].scale * v[i] + cases[c].shift;
        relume_codebook *book = book_of(codes, cases[c].codes, cases[c].dim);
        check_assignment(book, v, n, 0);
        check_assignment(book, v, n, ~0u);
        check_assignment(book, codes, (size_t)cases[c].codes, 0);
        relume_codebook_destroy(&book);
        free(codes);
        free(v);
    }
}

// Whole numbers: many vectors lie exactly between codes, and the lowest must win.
static void test_ties_go_to_the_lowest(void **state)
{
    (void)state;
    enum { SIDE = 6, CODES = SIDE * SIDE, N = 23 * 23 };
    float codes[CODES * 2], v[N * 2];
    for (int i = 0; i < CODES; i++) {
        codes[2 * i] = (float)(2 * (i * 5 % CODES % SIDE));
        codes[2 * i + 1] = (float)(2 * (i * 5 % CODES / SIDE));
    }
    for (int i = 0; i < N; i++) {
        v[2 * i] = (float)(i % 23) / 2.0f;
        v[2 * i + 1] = (float)(i / 23) / 2.0f;
    }
    relume_codebook *book = book_of(codes, CODES, 2);
    assert_memory_equal(relume_codebook_info(book)->vectors, codes, sizeof codes);
    check_assignment(book, v, N, 0);
    check_assignment(book, v, N, ~0u);
    relume_codebook_destroy(&book);
}

// Vectors far from a tight bundle of codes: single precision alone cannot separate them.
static void test_near_ties(void **state)
{
    (void)state;
    enum { CODES = 60, N = 400, DIM = 7 };
    float *codes = uniform(CODES * DIM, 1), *v = uniform(N * DIM, 2);
    for (int i = 0; i < CODES * DIM; i++)
        codes[i] = 1.0f + codes[i] * 1e-6f;
    for (int i = 0; i < N * DIM; i++)
        v[i] *= 100.0f;
    relume_codebook *book = book_of(codes, CODES, DIM);
    check_assignment(book, v, N, 0);
    check_assignment(book, v, N, ~0u);
    relume_codebook_destroy(&book);
    free(codes);
    free(v);
}

static void test_threads_cpu_and_seed(void **state)
{
    (void)state;
    enum { N = TEST_SANITIZED ? 4000 : 20000, DIM = 12, CODES = 100 };
    float *v = clusters(N, DIM, 11);
    for (int start = RELUME_START_RANDOM; start <= RELUME_START_SPLIT; start++) {
        relume_codebook *first = NULL;
        static const struct {
            int threads;
            unsigned off;
        } ways[] = {{1, 0}, {2, 0}, {7, RELUME_CPU_AVX512}, {3, ~0u}};
        for (size_t w = 0; w < 4; w++) {
            relume_codebook *book = train(
                v, N, DIM,
                relume_codebook_params(.codes = CODES, .start = (enum relume_codebook_start)start,
                                       .seed = 9, .threads = ways[w].threads,
                                       .cpu_off = ways[w].off, .sample = N * 9 / 20));
            if (!first) {
                first = book;
                continue;
            }
            assert_memory_equal(relume_codebook_info(book)->vectors,
                                relume_codebook_info(first)->vectors, CODES * DIM * sizeof(float));
            assert_int_equal(relume_codebook_info(book)->rounds,
                             relume_codebook_info(first)->rounds);
            relume_codebook_destroy(&book);
        }
        relume_codebook *other =
            train(v, N, DIM, relume_codebook_params(.codes = CODES, .seed = 10));
        assert_memory_not_equal(relume_codebook_info(other)->vectors,
                                relume_codebook_info(first)->vectors, CODES * DIM * sizeof(float));
        relume_codebook_destroy(&other);
        relume_codebook_destroy(&first);
    }
    free(v);
}

// All codes start in one place: all but one are empty, and each must find work.
static void test_empty_cells(void **state)
{
    (void)state;
    enum { N = 1000, DIM = 3, CODES = 20 };
    float *v = clusters(N, DIM, 4), start[CODES * DIM] = {0};
    relume_codebook *book =
        train(v, N, DIM, relume_codebook_params(.codes = CODES, .initial = start));
    const struct relume_codebook_info *info = relume_codebook_info(book);
    uint16_t index[N];
    int members[CODES] = {0};
    assert_true(info->moved >= CODES - 1);
    CHECK_OK(relume_codebook_assign(book, v, N, index, NULL, NULL));
    for (int i = 0; i < N; i++)
        members[index[i]]++;
    for (int c = 0; c < CODES; c++)
        assert_true(members[c] > 0);
    relume_codebook_destroy(&book);
    free(v);
}

// Three different vectors, eight codes: no error is left, and nothing breaks.
static void test_duplicates(void **state)
{
    (void)state;
    enum { N = 90, DIM = 4, CODES = 8 };
    float v[N * DIM];
    for (int i = 0; i < N * DIM; i++)
        v[i] = (float)(i / DIM % 3) - 0.3f * (float)(i % DIM);
    for (int start = RELUME_START_RANDOM; start <= RELUME_START_SPLIT; start++) {
        double error;
        uint16_t index[N];
        relume_codebook *book =
            train(v, N, DIM,
                  relume_codebook_params(.codes = CODES, .seed = 1,
                                         .start = (enum relume_codebook_start)start));
        CHECK_OK(relume_codebook_assign(book, v, N, index, &error, NULL));
        CHECK_NEAR(error, 0.0, 1e-12);
        relume_codebook_destroy(&book);
    }
}

static void test_as_many_codes_as_vectors(void **state)
{
    (void)state;
    enum { N = 130, DIM = 5 };
    float *v = uniform(N * DIM, 6);
    for (int start = RELUME_START_RANDOM; start <= RELUME_START_SPLIT; start++) {
        double error;
        uint16_t index[N];
        bool seen[N] = {false};
        relume_codebook *book =
            train(v, N, DIM,
                  relume_codebook_params(.codes = N, .min_gain = -1.0, .max_rounds = 200,
                                         .start = (enum relume_codebook_start)start));
        CHECK_OK(relume_codebook_assign(book, v, N, index, &error, NULL));
        assert_true(error == 0.0);
        for (int i = 0; i < N; i++) {
            assert_false(seen[index[i]]);
            seen[index[i]] = true;
        }
        relume_codebook_destroy(&book);
    }
    free(v);
}

// Two blobs of unequal weight: the means of both halves are known.
static void test_split_finds_the_axis(void **state)
{
    (void)state;
    enum { N = 3000, DIM = 2 };
    float *v = uniform(N * DIM, 12);
    double mean[2][DIM] = {{0}};
    int members[2] = {0, 0};
    for (int i = 0; i < N; i++) {
        const int blob = i % 3 == 0;
        members[blob]++;
        for (int k = 0; k < DIM; k++) {
            v[i * DIM + k] = v[i * DIM + k] + (blob ? 3.0f : -3.0f) * (k ? -1.0f : 1.0f);
            mean[blob][k] += (double)v[i * DIM + k];
        }
    }
    relume_codebook *book =
        train(v, N, DIM, relume_codebook_params(.codes = 2, .start = RELUME_START_SPLIT));
    const float *codes = relume_codebook_info(book)->vectors;
    const int first = codes[0] > codes[DIM] ? 0 : 1;
    for (int k = 0; k < DIM; k++) {
        CHECK_NEAR(codes[first * DIM + k], mean[1][k] / members[1], 1e-6);
        CHECK_NEAR(codes[(1 - first) * DIM + k], mean[0][k] / members[0], 1e-6);
    }
    relume_codebook_destroy(&book);
    free(v);
}

// As many tight groups as codes, far apart and of unequal size: the best book has a code in each,
// and its error is that of the groups around their means. Splitting alone left several groups to
// share a code (a hundred times that error).
static void test_codes_reach_every_group(void **state)
{
    (void)state;
    enum { GROUPS = 48, DIM = 5, MOST = 400 };
    static float v[GROUPS * MOST * DIM];
    size_t n = 0;
    double best = 0.0;
    uint32_t seed = 11;
    for (int g = 0; g < GROUPS; g++) {
        const size_t members = g % 5 ? 40 : MOST, first = n;
        double centre[DIM], mean[DIM] = {0.0};
        for (int k = 0; k < DIM; k++)
            centre[k] = 20.0 * test_uniform(&seed);
        for (; n < first + members; n++)
            for (int k = 0; k < DIM; k++) {
                v[n * DIM + (size_t)k] = (float)(centre[k] + 0.2 * test_uniform(&seed));
                mean[k] += (double)v[n * DIM + (size_t)k] / (double)members;
            }
        for (size_t i = first; i < n; i++)
            for (int k = 0; k < DIM; k++)
                best += pow((double)v[i * DIM + (size_t)k] - mean[k], 2.0);
    }
    relume_codebook *book =
        train(v, n, DIM, relume_codebook_params(.codes = GROUPS, .start = RELUME_START_SPLIT));
    CHECK_NEAR(relume_codebook_info(book)->squared_error, best, 1e-6 * best);  // means are floats
    relume_codebook_destroy(&book);
}

// Most rounds learn from a sample, the last ones from everything: a Lloyd round more gains nothing.
static void test_last_rounds_see_all(void **state)
{
    (void)state;
    enum { N = 4000, DIM = 3, CODES = 30 };
    float *v = clusters(N, DIM, 7);
    relume_codebook *book =
        train(v, N, DIM,
              relume_codebook_params(.codes = CODES, .sample = 300, .start = RELUME_START_SPLIT));
    const struct relume_codebook_info *info = relume_codebook_info(book);
    uint16_t *index = malloc(N * sizeof *index);
    double error;
    CHECK_OK(relume_codebook_assign(book, v, N, index, &error, NULL));
    assert_true(info->rounds <= 6);
    assert_true(error <= info->squared_error);
    CHECK_NEAR(error, info->squared_error, 0.02 * error);  // a book of the sample is 10 % off
    free(index);
    relume_codebook_destroy(&book);
    free(v);
}

static void expect_einval(const float *v, size_t n, int dim, struct relume_codebook_params p,
                          const char *word)
{
    struct test_log log;
    relume_codebook *book = (void *)1;
    test_log_init(&log);
    p.log = &log.log;
    assert_int_equal(relume_codebook_train(&book, v, n, dim, &p), RELUME_EINVAL);
    assert_null(book);
    assert_int_equal(log.lines, 1);
    assert_non_null(strstr(log.text, word));
}

static void test_bad_input(void **state)
{
    (void)state;
    float v[24] = {0}, bad[24] = {0};
    bad[13] = NAN;
    expect_einval(v, 8, 3, (struct relume_codebook_params){.codes = 9}, "at least as many vectors");
    expect_einval(v, 8, 3, (struct relume_codebook_params){.codes = 4, .sample = 3}, "found 3");
    expect_einval(v, 8, 3, (struct relume_codebook_params){0}, "256");
    expect_einval(bad, 8, 3, (struct relume_codebook_params){.codes = 2}, "vector 4 holds nan");
    expect_einval(v, 8, 3, (struct relume_codebook_params){.codes = 8, .initial = bad}, "start");
    expect_einval(v, 8, 0, (struct relume_codebook_params){.codes = 2}, "expected");
    expect_einval(v, 8, 3, (struct relume_codebook_params){.codes = 65537}, "65536");
    bad[13] = INFINITY;
    struct test_log log;
    uint16_t index[8];
    test_log_init(&log);
    relume_codebook *book = train(v, 8, 3, relume_codebook_params(.codes = 1));
    assert_int_equal(relume_codebook_assign(book, bad, 8, index, NULL,
                                            relume_codebook_assign_params(.log = &log.log)),
                     RELUME_EINVAL);
    assert_non_null(strstr(log.text, "vector 4 holds inf"));
    CHECK_OK(relume_codebook_assign(book, v, 0, index, NULL, NULL));
    relume_codebook_destroy(&book);
    relume_codebook_destroy(&book);
}

static bool stop(void *user, const char *what, double done)
{
    int *left = user;
    (void)what, (void)done;
    return (*left)-- > 0;
}

static void test_cancel(void **state)
{
    (void)state;
    float *v = uniform(3000, 3);
    for (int start = RELUME_START_RANDOM; start <= RELUME_START_SPLIT; start++)
        for (int left = 0; left < 3; left++) {
            int count = left;
            const struct relume_log log = {.progress = stop, .user = &count};
            relume_codebook *book = (void *)1;
            assert_int_equal(
                relume_codebook_train(
                    &book, v, 1000, 3,
                    relume_codebook_params(.log = &log, .codes = 16, .min_gain = -1.0,
                                           .start = (enum relume_codebook_start)start)),
                RELUME_ECANCEL);
            assert_null(book);
        }
    free(v);
}

static void test_allocations(void **state)
{
    (void)state;
    float *v = uniform(900, 3);
    uint16_t index[300];
    for (int start = RELUME_START_RANDOM; start <= RELUME_START_SPLIT; start++)
        for (int n = 1;; n++) {
            relume_codebook *book = NULL;
            mem_fail_after(n);
            relume_status status = relume_codebook_train(
                &book, v, 300, 3,
                relume_codebook_params(.codes = 5, .sample = 200, .threads = 1,
                                       .start = (enum relume_codebook_start)start));
            if (!status)
                status = relume_codebook_assign(book, v, 300, index, NULL, NULL);
            const bool done = mem_fail_pending();
            mem_fail_after(0);
            relume_codebook_destroy(&book);
            if (done) {
                CHECK_OK(status);
                break;
            }
            assert_int_equal(status, RELUME_ENOMEM);
            assert_true(n < 1000);
        }
    free(v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rounds_are_lloyds),
        cmocka_unit_test(test_error_never_rises),
        cmocka_unit_test(test_assignment_is_exact),
        cmocka_unit_test(test_ties_go_to_the_lowest),
        cmocka_unit_test(test_near_ties),
        cmocka_unit_test(test_threads_cpu_and_seed),
        cmocka_unit_test(test_empty_cells),
        cmocka_unit_test(test_duplicates),
        cmocka_unit_test(test_as_many_codes_as_vectors),
        cmocka_unit_test(test_split_finds_the_axis),
        cmocka_unit_test(test_codes_reach_every_group),
        cmocka_unit_test(test_last_rounds_see_all),
        cmocka_unit_test(test_bad_input),
        cmocka_unit_test(test_cancel),
        cmocka_unit_test(test_allocations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
