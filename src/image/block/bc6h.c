// bc6h.c - BC6H without its divided modes: half floats along one line a block, 16 steps between its
// ends
//
// ARB_texture_compression_bptc, of values from 0 on. Ends are numbers of 16 bits, 31 / 64 of which
// are the bits of a half float, so that steps along the line are about even in the logarithm. Four
// modes trade the bits of the first end for how far the second may be from it.
#include "image/block/bits.h"
#include "image/block/line.h"

#include "core/base/half.h"

#include <math.h>
#include <string.h>

enum { TURNS = 3, STEPS = 16 };
static const int parts[STEPS] = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};

struct mode {
    int number, bits, delta;  // delta: bits of the second end, from the first; 0: its own
};
static const struct mode modes[] = {{3, 10, 0}, {7, 11, 9}, {11, 12, 8}, {15, 16, 4}};
enum { MODES = sizeof modes / sizeof *modes };

struct choice {
    const struct mode *mode;
    int end[2][3];  // as stored, the second not yet as a difference
    uint8_t index[BLOCK_PIXELS];
    float error;
};

static int at_most(int v, int low, int high)
{
    return v < low ? low : v > high ? high : v;
}

// ---------------------------------------------------------------- numbers

// From stored bits to 16, and on to a half float.
static int widen(int q, int bits)
{
    if (bits == 16 || q == 0)
        return q;
    return q == (1 << bits) - 1 ? 0xffff : ((q << 15) + 0x4000) >> (bits - 1);
}

static uint16_t half_at(const int end[2][3], int c, int part, int bits)
{
    const int a = widen(end[0][c], bits), b = widen(end[1][c], bits);
    return (uint16_t)((((a * (64 - part) + b * part + 32) >> 6) * 31) >> 6);
}

static float wide_of(uint16_t half)
{
    return (64.0f * (float)half + 32.0f) / 31.0f;
}

// ---------------------------------------------------------------- what to store

static void choose(struct choice *c, const float (*value)[3])
{
    float palette[STEPS][3];
    for (int k = 0; k < STEPS; k++)
        for (int i = 0; i < 3; i++)
            palette[k][i] =
                float_from_half(half_at((const int(*)[3])c->end, i, parts[k], c->mode->bits));
    c->error = 0.0f;
    for (int i = 0; i < BLOCK_PIXELS; i++) {
        float least = INFINITY;
        for (int k = 0; k < STEPS; k++) {
            float error = 0.0f;
            for (int a = 0; a < 3; a++) {
                const float d = value[i][a] - palette[k][a];
                error += d * d;
            }
            if (error < least) {
                least = error;
                c->index[i] = (uint8_t)k;
            }
        }
        c->error += least;
    }
}

// The first pixel's index has its highest bit left out: it is 0, else the ends change places.
static int turns(const struct choice *c)
{
    return c->index[0] >= STEPS / 2;
}

static int fits(const struct choice *c)
{
    const int half = 1 << (c->mode->delta ? c->mode->delta - 1 : 16), turn = turns(c);
    for (int i = 0; i < 3; i++) {
        const int delta = c->end[!turn][i] - c->end[turn][i];
        if (delta < -half || delta >= half)
            return 0;
    }
    return 1;
}

static void take_better(struct choice *best, const struct line *line, const float (*value)[3])
{
    for (int m = 0; m < MODES; m++) {
        struct choice other = {.mode = &modes[m]};
        const int top = (1 << modes[m].bits) - 1;
        for (int e = 0; e < 2; e++)
            for (int c = 0; c < 3; c++)
                other.end[e][c] = at_most((int)line->end[e][c] >> (16 - modes[m].bits), 0, top);
        choose(&other, value);
        if (other.error < best->error && fits(&other))
            *best = other;
    }
}

// ---------------------------------------------------------------- bits

// Of one colour: the low bits stand together, the others behind the second end, highest first.
static void put_ends(struct bits *b, const struct choice *c)
{
    const int turn = turns(c), own = c->mode->delta ? c->mode->delta : c->mode->bits;
    for (int i = 0; i < 3; i++)
        bits_put(b, c->end[turn][i], 10);
    for (int i = 0; i < 3; i++) {
        const int first = c->end[turn][i], second = c->end[!turn][i];
        bits_put(b, c->mode->delta ? second - first : second, own);
        for (int bit = c->mode->bits - 1; bit >= 10; bit--)
            bits_put(b, first >> bit, 1);
    }
}

static void get_ends(int end[2][3], struct bits *b, const struct mode *m)
{
    const int own = m->delta ? m->delta : m->bits;
    for (int i = 0; i < 3; i++)
        end[0][i] = bits_get(b, 10);
    for (int i = 0; i < 3; i++) {
        int second = bits_get(b, own);
        for (int bit = m->bits - 1; bit >= 10; bit--)
            end[0][i] |= bits_get(b, 1) << bit;
        if (m->delta)
            second = end[0][i] + (second ^ 1 << (own - 1)) - (1 << (own - 1));
        end[1][i] = second & ((1 << m->bits) - 1);
    }
}

static void write(uint8_t *out, const struct choice *c)
{
    struct bits b = {out, 0};
    memset(out, 0, BLOCK_MOST_BYTES);
    bits_put(&b, c->mode->number, 5);
    put_ends(&b, c);
    for (int i = 0; i < BLOCK_PIXELS; i++)
        bits_put(&b, turns(c) ? STEPS - 1 - c->index[i] : c->index[i], i ? 4 : 3);
}

// ---------------------------------------------------------------- blocks

static void encode(uint8_t *out, const uint16_t (*rgb)[3])
{
    float value[BLOCK_PIXELS][3], wide[BLOCK_PIXELS][3];
    struct choice best = {.error = INFINITY};
    for (int i = 0; i < BLOCK_PIXELS; i++)
        for (int c = 0; c < 3; c++) {
            value[i][c] = float_from_half(rgb[i][c]);
            wide[i][c] = wide_of(rgb[i][c]);
        }
    struct line line = line_fit((const float(*)[3])wide, 65535.0f);
    take_better(&best, &line, (const float(*)[3])value);
    for (int turn = 0; turn < TURNS && best.error > 0.0f; turn++) {
        const float before = best.error;
        float at[BLOCK_PIXELS];
        for (int i = 0; i < BLOCK_PIXELS; i++)
            at[i] = (float)parts[best.index[i]] / 64.0f;
        if (!line_refit(&line, (const float(*)[3])wide, at, 65535.0f))
            break;
        take_better(&best, &line, (const float(*)[3])value);
        if (!(best.error < before))
            break;
    }
    write(out, &best);
}

static void decode(uint16_t (*rgb)[3], const uint8_t *in)
{
    uint8_t copy[BLOCK_MOST_BYTES];
    struct bits b = {memcpy(copy, in, sizeof copy), 0};
    const int number = bits_get(&b, 5);
    const struct mode *m = modes;
    int end[2][3];
    while (m < modes + MODES - 1 && m->number != number)
        m++;
    get_ends(end, &b, m);
    for (int i = 0; i < BLOCK_PIXELS; i++) {
        const int part = parts[bits_get(&b, i ? 4 : 3)];
        for (int c = 0; c < 3; c++)
            rgb[i][c] = half_at((const int(*)[3])end, c, part, m->bits);
    }
}

const struct block_format block_bc6h = {
    .name = "bc6h", .bytes = 16, .dxgi = 95, .encode_halves = encode, .decode_halves = decode};
