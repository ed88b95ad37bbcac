// test_codes.c - coefficients are the same numbers whatever they are stored as
#include "format/coder/coding.h"

#include "test.h"

enum { N = 12, PLANES = 3 };

// 0, 1, -2, 0.5, 65504 and 2^-10, by IEEE 754.
static const uint16_t halves[] = {0x0000, 0x3c00, 0xc000, 0x3800, 0x7bff, 0x1400};
static const double half_values[] = {0.0, 1.0, -2.0, 0.5, 65504.0, 1.0 / 1024};

struct codes {
    uint8_t bytes[PLANES][N];
    uint16_t words[PLANES][N];
    float floats[PLANES][N];
    const void *plane[PLANES];
    float scale[PLANES], offset[PLANES];
    struct relume_codes codes;
};

static double value(const struct codes *c, int p, int i)
{
    const double code = c->codes.storage == RELUME_STORE_8       ? 20 * p + i
                        : c->codes.storage == RELUME_STORE_HALF  ? half_values[(p + i) % 6]
                        : c->codes.storage == RELUME_STORE_FLOAT ? p + 0.25 * i
                                                                 : 300 * p + i;
    return code * (double)c->scale[p] + (double)c->offset[p];
}

static void make(struct codes *c, enum relume_storage storage)
{
    *c = (struct codes){.codes = {.width = 4, .height = 3, .planes = PLANES, .storage = storage}};
    for (int p = 0; p < PLANES; p++) {
        for (int i = 0; i < N; i++) {
            c->bytes[p][i] = (uint8_t)(20 * p + i);
            c->words[p][i] =
                storage == RELUME_STORE_HALF ? halves[(p + i) % 6] : (uint16_t)(300 * p + i);
            c->floats[p][i] = (float)p + 0.25f * (float)i;
        }
        c->plane[p] = storage == RELUME_STORE_8       ? (const void *)c->bytes[p]
                      : storage == RELUME_STORE_FLOAT ? (const void *)c->floats[p]
                                                      : (const void *)c->words[p];
        c->scale[p] = 0.5f + (float)p;
        c->offset[p] = 0.25f * (float)p;
    }
    c->codes.plane = c->plane;
    c->codes.scale = c->scale;
    c->codes.offset = c->offset;
}

// All numbers here are dyadic: nothing is rounded.
static void test_every_storage(void **state)
{
    (void)state;
    for (int storage = RELUME_STORE_8; storage <= RELUME_STORE_FLOAT; storage++) {
        struct codes c;
        make(&c, (enum relume_storage)storage);
        for (int p = 0; p < PLANES; p++)
            for (int first = 0; first < N; first += 5) {
                float got[N];
                relume_codes_plane(&c.codes, p, (size_t)first, (size_t)(N - first), got);
                for (int i = first; i < N; i++)
                    CHECK_NEAR((double)got[i - first], value(&c, p, i), 0.0);
            }
    }
}

static void test_some_pixels(void **state)
{
    (void)state;
    for (int storage = RELUME_STORE_8; storage <= RELUME_STORE_FLOAT; storage++) {
        struct codes c;
        struct relume_codes_part part;
        make(&c, (enum relume_storage)storage);
        for (size_t step = 1; step < 4; step++) {
            const size_t n = (N - 1 + step - 1) / step;
            float got[N];
            CHECK_OK(relume_codes_pick(&part, &c.codes, 1, step, n));
            assert_int_equal(part.codes.width, n);
            assert_int_equal(part.codes.height, 1);
            for (int p = 0; p < PLANES; p++) {
                relume_codes_plane(&part.codes, p, 0, n, got);
                for (size_t i = 0; i < n; i++)
                    CHECK_NEAR((double)got[i], value(&c, p, (int)(1 + i * step)), 0.0);
            }
            relume_codes_part_destroy(&part);
        }
    }
}

static void test_books(void **state)
{
    (void)state;
    const uint16_t index[2][N] = {{0, 1, 2, 0, 1, 2}, {1, 1, 0, 0, 1, 1}};
    const float first[] = {1, 2, 3, 10, 20, 30, 100, 200, 300},
                second[] = {0.5f, 0, 0, 0, 7, 0.25f};
    const uint16_t *indices[] = {index[0], index[1]};
    const float *vectors[] = {first, second};
    const int counts[] = {3, 2};
    const struct relume_codes codes = {.width = 4,
                                       .height = 3,
                                       .planes = PLANES,
                                       .books = 2,
                                       .index = indices,
                                       .vectors = vectors,
                                       .book_codes = counts};
    struct relume_codes_part part;
    float got[N];
    CHECK_OK(relume_codes_pick(&part, &codes, 1, 2, 5));
    for (int p = 0; p < PLANES; p++) {
        relume_codes_plane(&codes, p, 1, N - 1, got);
        for (int i = 1; i < N; i++)
            CHECK_NEAR((double)got[i - 1],
                       (double)first[3 * index[0][i] + p] + (double)second[3 * index[1][i] + p],
                       0.0);
        relume_codes_plane(&part.codes, p, 0, 5, got);
        for (int i = 0; i < 5; i++)
            CHECK_NEAR((double)got[i],
                       (double)first[3 * index[0][1 + 2 * i] + p] +
                           (double)second[3 * index[1][1 + 2 * i] + p],
                       0.0);
    }
    relume_codes_part_destroy(&part);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_storage),
        cmocka_unit_test(test_some_pixels),
        cmocka_unit_test(test_books),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
