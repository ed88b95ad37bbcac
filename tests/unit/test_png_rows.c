// test_png_rows.c - tests of src/image/image/png_rows.h: rows come back from their stream, which
// does not depend on threads
#include "test.h"

#include "image/image/png_rows.h"

#include <zlib.h>

// The stream of the pieces, whose size goes to *size; the caller frees it.
static uint8_t *deflated(const struct picture_array *array, int threads, size_t *size)
{
    struct png_piece *piece;
    size_t count;
    assert_int_equal(png_rows_deflate(&piece, &count, array, 2, threads), RELUME_OK);
    uint8_t *all = malloc(1);
    *size = 0;
    for (size_t i = 0; i < count; i++) {
        all = realloc(all, *size + piece[i].size);
        memcpy(all + *size, piece[i].data, piece[i].size);
        *size += piece[i].size;
    }
    png_rows_destroy(&piece, count);
    return all;
}

static int predicted(int filter, int left, int up, int corner)
{
    const int p = left + up - corner;
    const int a = abs(p - left), b = abs(p - up), c = abs(p - corner);
    const int nearest = a <= b && a <= c ? left : b <= c ? up : corner;
    const int all[] = {0, left, up, (left + up) / 2, nearest};
    return all[filter];
}

// Undoes the filters of PNG (W3C, Portable Network Graphics, 9) in place.
static void unfilter(uint8_t *lines, size_t row, int height, size_t pixel)
{
    for (int y = 0; y < height; y++) {
        uint8_t *at = lines + (size_t)y * (1 + row) + 1, *up = at - 1 - row;
        assert_in_range(at[-1], 0, 4);
        for (size_t i = 0; i < row; i++)
            at[i] =
                (uint8_t)(at[i] + predicted(at[-1], i < pixel ? 0 : at[i - pixel], y ? up[i] : 0,
                                            y && i >= pixel ? up[i - pixel] : 0));
    }
}

static void check_rows(int width, int height, int channels, size_t bytes)
{
    const size_t pixel = (size_t)channels * bytes, row = (size_t)width * pixel;
    const size_t n = row * (size_t)height, lines = n + (size_t)height;
    uint8_t *samples = malloc(n), *back = malloc(lines);
    uint32_t seed = 3;
    size_t size, size_of_one;
    for (size_t i = 0; i < n; i++)
        samples[i] =
            (uint8_t)(i / pixel % 251 + i / row + (i > n / 2 ? test_random(&seed) % 7 : 0));
    const struct picture_array array = {
        .data = samples, .bytes = bytes, .width = width, .height = height, .channels = channels};
    uint8_t *stream = deflated(&array, 7, &size), *one = deflated(&array, 1, &size_of_one);
    assert_int_equal(size, size_of_one);
    assert_memory_equal(stream, one, size);
    uLongf read = (uLongf)lines;
    assert_int_equal(uncompress(back, &read, stream, (uLong)size), Z_OK);
    assert_int_equal(read, lines);
    unfilter(back, row, height, pixel);
    for (int y = 0; y < height; y++)
        for (size_t i = 0; i < row; i++) {
            const size_t in = bytes == 2 ? i ^ 1 : i;  // the higher byte first
            assert_int_equal(back[(size_t)y * (1 + row) + 1 + i], samples[(size_t)y * row + in]);
        }
    free(samples);
    free(back);
    free(stream);
    free(one);
}

static void test_rows(void **state)
{
    (void)state;
    check_rows(1, 1, 1, 1);
    check_rows(5, 3, 3, 1);
    check_rows(301, 700, 3, 1);
    check_rows(257, 300, 4, 2);
    check_rows(400, 1100, 1, 1);
    check_rows(70000, 9, 4, 1);  // rows longer than a strip
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_rows)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
