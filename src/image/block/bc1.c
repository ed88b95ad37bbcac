// bc1.c - BC1, once DXT1: two colours of 16 bits and a choice among four for each pixel
//
// The encoder begins with the principal axis, then takes turns (Brown's squish): each pixel the
// nearest of the four colours, the line of least squares for that choice. At last it tries the
// neighbours of each of the six numbers. Always the form without a transparent colour.
#include "image/block/line.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { TURNS = 3, COLOURS = 4 };
static const int steps[3] = {31, 63, 31};
static const float parts[COLOURS] = {0.0f, 1.0f, 1.0f / 3.0f, 2.0f / 3.0f};

struct ends {
    int q[2][3];  // 5, 6 and 5 bits
};

struct choice {
    struct ends ends;
    uint8_t index[BLOCK_PIXELS];
    int error;
};

static int widen(int q, int c)
{
    return c == 1 ? q << 2 | q >> 4 : q << 3 | q >> 2;
}

static void make_palette(int palette[COLOURS][3], const struct ends *e)
{
    for (int c = 0; c < 3; c++) {
        const int a = widen(e->q[0][c], c), b = widen(e->q[1][c], c);
        palette[0][c] = a;
        palette[1][c] = b;
        palette[2][c] = (2 * a + b + 1) / 3;
        palette[3][c] = (a + 2 * b + 1) / 3;
    }
}

static struct choice choose(const struct ends *ends, const uint8_t (*rgb)[3])
{
    struct choice out = {.ends = *ends};
    int palette[COLOURS][3];
    make_palette(palette, ends);
    out.error = line_nearest(out.index, (const int(*)[3])palette, COLOURS, rgb);
    return out;
}

static struct ends quantise(const struct line *line)
{
    struct ends e;
    for (int i = 0; i < 2; i++)
        for (int c = 0; c < 3; c++)
            e.q[i][c] = (int)lrintf(line->end[i][c] * (float)steps[c] / 255.0f);
    return e;
}

static void take_better(struct choice *best, const struct ends *ends, const uint8_t (*rgb)[3])
{
    const struct choice other = choose(ends, rgb);
    if (other.error < best->error)
        *best = other;
}

static void take_turns(struct choice *best, const uint8_t (*rgb)[3], const float (*value)[3])
{
    for (int turn = 0; turn < TURNS && best->error; turn++) {
        const int before = best->error;
        struct line line;
        float at[BLOCK_PIXELS];
        for (int i = 0; i < BLOCK_PIXELS; i++)
            at[i] = parts[best->index[i]];
        if (!line_refit(&line, value, at, 255.0f))
            return;
        const struct ends ends = quantise(&line);
        take_better(best, &ends, rgb);
        if (best->error == before)
            return;
    }
}

static void try_neighbours(struct choice *best, const uint8_t (*rgb)[3])
{
    for (int n = 0; n < 12 && best->error; n++) {
        struct ends e = best->ends;
        int *q = &e.q[n / 6][n / 2 % 3];
        *q += n % 2 ? 1 : -1;
        if (*q >= 0 && *q <= steps[n / 2 % 3])
            take_better(best, &e, rgb);
    }
}

static unsigned packed(const int q[3])
{
    return (unsigned)(q[0] << 11 | q[1] << 5 | q[2]);
}

// The first colour as a number is the larger one: that says there are four. Equal ones are one.
static void write(uint8_t *out, const struct choice *best)
{
    const unsigned first = packed(best->ends.q[0]), second = packed(best->ends.q[1]);
    const bool turn = first < second;
    const unsigned a = turn ? second : first, b = turn ? first : second;
    uint32_t bits = 0;
    for (unsigned i = 0; i < BLOCK_PIXELS && a != b; i++)
        bits |= (uint32_t)(best->index[i] ^ (turn ? 1u : 0u)) << 2 * i;
    const uint8_t bytes[8] = {(uint8_t)a,
                              (uint8_t)(a >> 8),
                              (uint8_t)b,
                              (uint8_t)(b >> 8),
                              (uint8_t)bits,
                              (uint8_t)(bits >> 8),
                              (uint8_t)(bits >> 16),
                              (uint8_t)(bits >> 24)};
    memcpy(out, bytes, sizeof bytes);
}

static void encode(uint8_t *out, const uint8_t (*rgb)[3])
{
    float value[BLOCK_PIXELS][3];
    line_values(value, rgb);
    const struct line line = line_fit((const float(*)[3])value, 255.0f);
    const struct ends ends = quantise(&line);
    struct choice best = choose(&ends, rgb);
    take_turns(&best, rgb, (const float(*)[3])value);
    try_neighbours(&best, rgb);
    write(out, &best);
}

static void decode(uint8_t (*rgb)[3], const uint8_t *in)
{
    const unsigned first = in[0] | (unsigned)in[1] << 8, second = in[2] | (unsigned)in[3] << 8;
    const struct ends e = {{{(int)(first >> 11), (int)(first >> 5 & 63), (int)(first & 31)},
                            {(int)(second >> 11), (int)(second >> 5 & 63), (int)(second & 31)}}};
    int palette[COLOURS][3];
    make_palette(palette, &e);
    for (int c = 0; c < 3 && first <= second; c++) {  // three colours, and black
        palette[2][c] = (palette[0][c] + palette[1][c]) / 2;
        palette[3][c] = 0;
    }
    for (int i = 0; i < BLOCK_PIXELS; i++)
        for (int c = 0; c < 3; c++)
            rgb[i][c] = (uint8_t)palette[in[4 + i / 4] >> 2 * (i % 4) & 3][c];
}

const struct block_format block_bc1 = {
    .name = "bc1", .bytes = 8, .dxgi = 71, .encode = encode, .decode = decode};
