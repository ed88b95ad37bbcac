// disparity.c - whole steps foretold by the three neighbours above and to the left, then deflated
#include "lossy/disparity.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>
#include <zlib.h>

// Words at the head, before the deflated bytes: their number and CRC-32. Inflated they are the low
// bytes of what differs from the foretold, then the high bytes.
enum { WORD_MAGIC, WORD_BYTES, WORD_CRC, HEAD_WORDS };
enum { MAGIC = 0x31444C52, MOST_STEPS = 65535 };  // "RLD1"

// Of the left, the upper and the upper left neighbour: the least or the most of the first two
// across an edge, else the plane through all (Weinberger et al. 2000, LOCO-I).
static int foretold(const uint16_t *row, const uint16_t *above, size_t x)
{
    const int a = x ? row[x - 1] : above ? above[x] : 0;
    const int b = above ? above[x] : a, c = above && x ? above[x - 1] : b;
    const int least = a < b ? a : b, most = a < b ? b : a;
    return c >= most ? least : c <= least ? most : a + b - c;
}

// Differences, small ones of either sign first, modulo 65536.
static uint16_t fold(int difference)
{
    const int d = (int16_t)(uint16_t)difference;
    return (uint16_t)(d < 0 ? -2 * d - 1 : 2 * d);
}

static int unfold(unsigned folded)
{
    return folded & 1 ? -(int)(folded / 2) - 1 : (int)(folded / 2);
}

static uint16_t steps_of(float depth, float step)
{
    if (isinf(depth))
        return 0;
    const double steps = rint(1.0 / ((double)depth * step));
    return (uint16_t)(steps < 1.0 ? 1.0 : steps > MOST_STEPS ? MOST_STEPS : steps);
}

static void fold_all(unsigned char *bytes, uint16_t *row, const struct relume_image *depth,
                     float step)
{
    const size_t width = (size_t)depth->width, n = width * (size_t)depth->height;
    uint16_t *above = NULL, *now = row;
    for (size_t i = 0; i < n; i += width) {
        for (size_t x = 0; x < width; x++)
            now[x] = steps_of(depth->data[i + x], step);
        for (size_t x = 0; x < width; x++) {
            const uint16_t d = fold(now[x] - foretold(now, above, x));
            bytes[i + x] = (unsigned char)d;
            bytes[n + i + x] = (unsigned char)(d >> 8);
        }
        above = now;
        now = now == row ? row + width : row;
    }
}

static float nearest(const struct relume_image *depth)
{
    const size_t n = (size_t)depth->width * (size_t)depth->height;
    float least = INFINITY;
    for (size_t i = 0; i < n; i++)
        least = depth->data[i] > 0.0f && depth->data[i] < least ? depth->data[i] : least;
    return least;
}

relume_status disparity_encode(struct lossy_words *out, float *step,
                               const struct relume_image *depth)
{
    const size_t width = (size_t)depth->width, n = width * (size_t)depth->height;
    uLongf size = compressBound((uLong)(2 * n));
    unsigned char *bytes = mem_array(2 * n, 1), *deflated = mem_array(size, 1);
    uint16_t *rows = mem_array(2 * width, sizeof *rows);
    const float least = 1.0f / nearest(depth) / MOST_STEPS;
    relume_status status = bytes && deflated && rows ? RELUME_OK : RELUME_ENOMEM;
    *step = *step > least ? *step : least > 0.0f ? least : 1.0f;
    *out = (struct lossy_words){0};
    if (!status) {
        fold_all(bytes, rows, depth, *step);
        status = compress2(deflated, &size, bytes, (uLong)(2 * n), 9) == Z_OK ? RELUME_OK
                                                                              : RELUME_ENOMEM;
    }
    if (!status) {
        out->count = HEAD_WORDS + (size + 3) / 4;
        out->word = mem_zeroed(out->count, sizeof *out->word);
        status = out->word ? RELUME_OK : RELUME_ENOMEM;
    }
    if (!status) {
        out->word[WORD_MAGIC] = MAGIC;
        out->word[WORD_BYTES] = (uint32_t)size;
        out->word[WORD_CRC] = (uint32_t)crc32(0, deflated, (uInt)size);
        lossy_put_bytes(out->word + HEAD_WORDS, deflated, size);
    }
    mem_free(bytes);
    mem_free(deflated);
    mem_free(rows);
    return status;
}

static void unfold_all(struct relume_image *depth, uint16_t *row, const unsigned char *bytes,
                       float step)
{
    const size_t width = (size_t)depth->width, n = width * (size_t)depth->height;
    uint16_t *above = NULL, *now = row;
    for (size_t i = 0; i < n; i += width) {
        for (size_t x = 0; x < width; x++) {
            const unsigned folded = bytes[i + x] | (unsigned)bytes[n + i + x] << 8;
            now[x] = (uint16_t)(foretold(now, above, x) + unfold(folded));
            depth->data[i + x] = now[x] ? (float)(1.0 / ((double)now[x] * step)) : INFINITY;
        }
        above = now;
        now = now == row ? row + width : row;
    }
}

relume_status disparity_decode(struct relume_image *depth, const struct lossy_words *words,
                               float step)
{
    const size_t width = (size_t)depth->width, n = width * (size_t)depth->height;
    if (words->count < HEAD_WORDS || words->word[WORD_MAGIC] != MAGIC ||
        words->word[WORD_BYTES] > 4 * (words->count - HEAD_WORDS))
        return RELUME_EDAMAGED;
    const size_t size = words->word[WORD_BYTES];
    uLongf inflated = (uLongf)(2 * n);
    unsigned char *deflated = mem_array(size, 1), *bytes = mem_array(2 * n, 1);
    uint16_t *rows = mem_array(2 * width, sizeof *rows);
    relume_status status = deflated && bytes && rows ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        lossy_take_bytes(deflated, words->word + HEAD_WORDS, size);
        if (crc32(0, deflated, (uInt)size) != words->word[WORD_CRC] ||
            uncompress(bytes, &inflated, deflated, (uLong)size) != Z_OK || inflated != 2 * n)
            status = RELUME_EDAMAGED;
    }
    if (!status)
        unfold_all(depth, rows, bytes, step);
    mem_free(deflated);
    mem_free(bytes);
    mem_free(rows);
    return status;
}
