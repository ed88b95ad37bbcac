// bc7.c - BC7 in its mode 6: two colours of 7 bits with a last bit of their own, 16 steps between
//
// One line through a block, as BC1 has it, with colours 8 times and steps 5 times as fine. The
// modes that divide a block are left out: eigenimages are smooth, and one mode is short.
#include "image/block/bits.h"
#include "image/block/line.h"

#include <limits.h>
#include <math.h>
#include <string.h>

enum { TURNS = 3, STEPS = 16 };
static const int parts[STEPS] = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};

struct choice {
    int end[2][3];  // 8 bits, the last of which is that of all three
    uint8_t index[BLOCK_PIXELS];
    int error;
};

static void choose(struct choice *c, const uint8_t (*rgb)[3])
{
    int palette[STEPS][3];
    for (int k = 0; k < STEPS; k++)
        for (int i = 0; i < 3; i++)
            palette[k][i] = ((64 - parts[k]) * c->end[0][i] + parts[k] * c->end[1][i] + 32) >> 6;
    c->error = line_nearest(c->index, (const int(*)[3])palette, STEPS, rgb);
}

// The nearest of 128 values with that last bit.
static int quantise(float v, int last)
{
    const int q = (int)lrintf((v - (float)last) / 2.0f);
    return (q < 0 ? 0 : q > 127 ? 127 : q) << 1 | last;
}

static void take_better(struct choice *best, const struct line *line, const uint8_t (*rgb)[3])
{
    for (int last = 0; last < 4; last++) {
        struct choice other = {.error = 0};
        for (int e = 0; e < 2; e++)
            for (int c = 0; c < 3; c++)
                other.end[e][c] = quantise(line->end[e][c], last >> e & 1);
        choose(&other, rgb);
        if (other.error < best->error)
            *best = other;
    }
}

// The first pixel's index has its highest bit left out: it is 0, else the ends change places.
static void write(uint8_t *out, const struct choice *c)
{
    const int turn = c->index[0] >= STEPS / 2;
    struct bits b = {out, 0};
    memset(out, 0, BLOCK_MOST_BYTES);
    bits_put(&b, 1 << 6, 7);
    for (int i = 0; i < 3; i++)
        for (int e = 0; e < 2; e++)
            bits_put(&b, c->end[e ^ turn][i] >> 1, 7);
    bits_put(&b, 127, 7);  // alpha: all there is
    bits_put(&b, 127, 7);
    for (int e = 0; e < 2; e++)
        bits_put(&b, c->end[e ^ turn][0] & 1, 1);
    for (int i = 0; i < BLOCK_PIXELS; i++)
        bits_put(&b, turn ? STEPS - 1 - c->index[i] : c->index[i], i ? 4 : 3);
}

static void encode(uint8_t *out, const uint8_t (*rgb)[3])
{
    struct choice best = {.error = INT_MAX};
    float value[BLOCK_PIXELS][3];
    line_values(value, rgb);
    struct line line = line_fit((const float(*)[3])value, 255.0f);
    take_better(&best, &line, rgb);
    for (int turn = 0; turn < TURNS && best.error; turn++) {
        const int before = best.error;
        float at[BLOCK_PIXELS];
        for (int i = 0; i < BLOCK_PIXELS; i++)
            at[i] = (float)parts[best.index[i]] / 64.0f;
        if (!line_refit(&line, (const float(*)[3])value, at, 255.0f))
            break;
        take_better(&best, &line, rgb);
        if (best.error == before)
            break;
    }
    write(out, &best);
}

static void decode(uint8_t (*rgb)[3], const uint8_t *in)
{
    uint8_t copy[BLOCK_MOST_BYTES];
    struct bits b = {memcpy(copy, in, sizeof copy), 7};
    int end[2][3];
    for (int i = 0; i < 3; i++)
        for (int e = 0; e < 2; e++)
            end[e][i] = bits_get(&b, 7) << 1;
    (void)bits_get(&b, 14);
    for (int e = 0; e < 2; e++) {
        const int last = bits_get(&b, 1);
        for (int i = 0; i < 3; i++)
            end[e][i] |= last;
    }
    for (int i = 0; i < BLOCK_PIXELS; i++) {
        const int part = parts[bits_get(&b, i ? 4 : 3)];
        for (int c = 0; c < 3; c++)
            rgb[i][c] = (uint8_t)(((64 - part) * end[0][c] + part * end[1][c] + 32) >> 6);
    }
}

const struct block_format block_bc7 = {
    .name = "bc7", .bytes = 16, .dxgi = 98, .encode = encode, .decode = decode};
