// trellis.c - rate-distortion optimised quantisation for JPEG
//
// A block costs its squared error + lambda x bits. What bits a choice takes follows from how often
// each symbol (run of zeros, size) occurs, so statistics and choices are made in turn, a few rounds
// (the idea of entropy-constrained quantisation, Chou, Lookabaugh, Gray 1989; for runs and sizes of
// JPEG: Ramchandran and Vetterli 1994). Within a block the best choice is a shortest path over the
// coefficients that stay. The model is one progressive scan of all AC coefficients: a run of empty
// blocks is one symbol, paid by the block before it.
#include "image/image/trellis.h"

#include <math.h>
#include <string.h>

enum { ROUNDS = 3, SIZES = 12, TOP = 1023 };

static const uint8_t zigzag[64] = {0,  1,  8,  16, 9,  2,  3,  10, 17, 24, 32, 25, 18, 11, 4,  5,
                                   12, 19, 26, 33, 40, 48, 41, 34, 27, 20, 13, 6,  7,  14, 21, 28,
                                   35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23, 30, 37, 44, 51,
                                   58, 59, 52, 45, 38, 31, 39, 46, 53, 60, 61, 54, 47, 55, 62, 63};

size_t trellis_blocks(int width, int height)
{
    return (size_t)((width + 7) / 8) * (size_t)((height + 7) / 8);
}

// ---------------------------------------------------------------- transform

struct cosines {
    float c[8][8];  // [frequency][position]
};

static struct cosines make_cosines(void)
{
    struct cosines t;
    for (int f = 0; f < 8; f++)
        for (int x = 0; x < 8; x++)
            t.c[f][x] = (float)(cos((2 * x + 1) * f * M_PI / 16.0) * (f ? 0.5 : sqrt(0.125)));
    return t;
}

static void transform_block(const struct cosines *t, const float in[64], float *out)
{
    float half[64];
    for (int y = 0; y < 8; y++)
        for (int f = 0; f < 8; f++) {
            float sum = 0.0f;
            for (int x = 0; x < 8; x++)
                sum += in[8 * y + x] * t->c[f][x];
            half[8 * y + f] = sum;
        }
    for (int k = 0; k < 64; k++) {
        const int f = zigzag[k] / 8, column = zigzag[k] % 8;
        float sum = 0.0f;
        for (int y = 0; y < 8; y++)
            sum += half[8 * y + column] * t->c[f][y];
        out[k] = sum;
    }
}

void trellis_transform(const float *plane, int width, int height, float *out)
{
    const struct cosines t = make_cosines();
    for (int top = 0; top < height; top += 8)
        for (int left = 0; left < width; left += 8, out += 64) {
            float block[64];
            for (int y = 0; y < 8; y++) {
                const size_t row = (size_t)(top + y < height ? top + y : height - 1);
                for (int x = 0; x < 8; x++)
                    block[8 * y + x] = plane[row * (size_t)width +
                                             (size_t)(left + x < width ? left + x : width - 1)];
            }
            transform_block(&t, block, out);
        }
}

// ---------------------------------------------------------------- statistics

struct counts {
    double ac[16][SIZES];  // [run][size]; [15][0] is sixteen zeros
    double dc[SIZES];
    double end[16];  // runs of ended blocks by the number of their bits
    double ended;    // blocks that begin such a run
};

struct costs {
    double ac[16][SIZES];
    double dc[SIZES];
    double end;  // of a block whose last coefficient is not the 63rd
};

static int size_of(int v)
{
    return v ? 32 - __builtin_clz((unsigned)(v < 0 ? -v : v)) : 0;
}

static void count_end_run(struct counts *n, size_t *run)
{
    if (*run)
        n->end[size_of((int)(*run < 32767 ? *run : 32767)) - 1]++;
    *run = 0;
}

static void count_block(struct counts *n, const int16_t *codes, size_t *end_run)
{
    int last = 0;
    for (int k = 1; k < 64; k++) {
        if (!codes[k])
            continue;
        if (last == 0)
            count_end_run(n, end_run);
        int run = k - last - 1;
        for (; run > 15; run -= 16)
            n->ac[15][0]++;
        n->ac[run][size_of(codes[k])]++;
        last = k;
    }
    if (last > 0 && last < 63)
        n->ended++;
    if (last < 63)
        ++*end_run;
}

static struct counts count_symbols(const int16_t *codes, size_t blocks)
{
    struct counts n = {0};
    size_t end_run = 0;
    int before = 0;
    for (size_t b = 0; b < blocks; b++, codes += 64) {
        n.dc[size_of(codes[0] - before)]++;
        before = codes[0];
        count_block(&n, codes, &end_run);
    }
    count_end_run(&n, &end_run);
    return n;
}

static double code_length(double count, double total)
{
    return fmax(1.0, log2(total / count));
}

// Symbols that have not been seen cost as if they had occurred half a time.
static struct costs costs_of(const struct counts *n, double *bits)
{
    struct costs c;
    double total_ac = 0.0, total_dc = 0.0, end_bits = 0.0;
    *bits = 0.0;
    for (int s = 0; s < SIZES; s++) {
        total_dc += n->dc[s] + 0.5;
        for (int r = 0; r < 16; r++)
            total_ac += n->ac[r][s] + 0.5;
    }
    for (int e = 0; e < 16; e++)
        total_ac += n->end[e];
    for (int s = 0; s < SIZES; s++) {
        c.dc[s] = code_length(n->dc[s] + 0.5, total_dc) + s;
        *bits += n->dc[s] * c.dc[s];
        for (int r = 0; r < 16; r++) {
            c.ac[r][s] = code_length(n->ac[r][s] + 0.5, total_ac) + s;
            *bits += n->ac[r][s] * c.ac[r][s];
        }
    }
    for (int e = 0; e < 16; e++)
        if (n->end[e] > 0.0)
            end_bits += n->end[e] * (code_length(n->end[e], total_ac) + e);
    *bits += end_bits;
    c.end = n->ended > 0.0 ? end_bits / n->ended : 4.0;
    return c;
}

// ---------------------------------------------------------------- choices

struct choice {
    double cost;  // of everything up to here, given that this coefficient stays
    int position, before, value;
};

// Bits of a coefficient after `run` zeros.
static double ac_bits(const struct costs *c, int run, int size)
{
    return (double)(run / 16) * c->ac[15][0] + c->ac[run % 16][size];
}

// The value, at most a step below the nearest, that is cheapest after `run` zeros.
static int best_value(const struct costs *c, double x, double lambda, int run, double *cost)
{
    const int nearest = (int)fmin(floor(fabs(x) + 0.5), TOP);
    int value = nearest;
    *cost = 1e300;
    for (int v = nearest; v >= 1 && v >= nearest - 1; v--) {
        const double d = fabs(x) - v, total = d * d + lambda * ac_bits(c, run, size_of(v));
        if (total < *cost) {
            *cost = total;
            value = v;
        }
    }
    return x < 0.0 ? -value : value;
}

// AC coefficients of one block, in units of the step.
static void choose_ac(const struct costs *c, const double *x, double lambda, int16_t *codes)
{
    double zeros[65];  // zeros[k]: distortion of positions 1..k-1 set to zero
    struct choice path[64];
    int n = 1;
    path[0] = (struct choice){0};
    zeros[1] = 0.0;
    for (int k = 1; k < 64; k++) {
        zeros[k + 1] = zeros[k] + x[k] * x[k];
        codes[k] = 0;
        if (fabs(x[k]) < 0.5)
            continue;
        struct choice best = {.cost = 1e300};
        for (int i = n - 1; i >= 0; i--) {
            const double skipped = zeros[k] - zeros[path[i].position + 1];
            if (skipped > best.cost)
                break;
            double cost;
            const int value = best_value(c, x[k], lambda, k - path[i].position - 1, &cost);
            cost += path[i].cost + skipped;
            if (cost < best.cost)
                best = (struct choice){cost, k, i, value};
        }
        path[n++] = best;
    }
    int last = 0;
    double least = zeros[64];
    for (int i = 1; i < n; i++) {
        const double cost = path[i].cost + zeros[64] - zeros[path[i].position + 1] +
                            (path[i].position < 63 ? lambda * c->end : 0.0);
        if (cost < least) {
            least = cost;
            last = i;
        }
    }
    for (int i = last; i > 0; i = path[i].before)
        codes[path[i].position] = (int16_t)path[i].value;
}

// DC coefficients are coded as differences: a shortest path with two values for each block, the
// nearest and the second nearest..
static void choose_dc(const struct costs *c, const float *dct, size_t blocks, double step,
                      double lambda, int16_t *codes)
{
    double cost[2] = {0.0, 1e300};
    int value[2] = {0, 0};
    for (size_t b = 0; b < blocks; b++) {
        const double x = (double)dct[64 * b] / step;
        const int nearest = (int)fmax(fmin(floor(x + 0.5), TOP), -TOP);
        const int other = x > nearest ? nearest + 1 : nearest - 1;
        const int to[2] = {nearest, other > TOP || other < -TOP ? nearest : other};
        double next[2];
        int back = 0;
        for (int t = 0; t < 2; t++) {
            const double stay = cost[0] + lambda * c->dc[size_of(to[t] - value[0])];
            const double move = cost[1] + lambda * c->dc[size_of(to[t] - value[1])];
            back |= (move < stay) << t;
            next[t] = (move < stay ? move : stay) + (x - to[t]) * (x - to[t]);
        }
        // AC places hold both values and where they came from until the way back
        codes[64 * b] = (int16_t)to[0];
        codes[64 * b + 1] = (int16_t)to[1];
        codes[64 * b + 2] = (int16_t)back;
        memcpy(cost, next, sizeof cost);
        memcpy(value, to, sizeof value);
    }
    int state = cost[1] < cost[0];
    for (size_t b = blocks; b-- > 0;) {
        const int back = codes[64 * b + 2] >> state & 1;
        codes[64 * b] = codes[64 * b + state];
        state = back;
    }
}

static void round_all(const float *dct, size_t blocks, double step, int16_t *codes)
{
    for (size_t i = 0; i < 64 * blocks; i++)
        codes[i] = (int16_t)fmax(fmin(rint((double)dct[i] / step), TOP), -TOP);
}

static void choose_all(const struct costs *c, const float *dct, size_t blocks, double step,
                       double lambda, int16_t *codes)
{
    choose_dc(c, dct, blocks, step, lambda, codes);
    for (size_t b = 0; b < blocks; b++) {
        double x[64];
        for (int k = 0; k < 64; k++)
            x[k] = (double)dct[64 * b + (size_t)k] / step;
        choose_ac(c, x, lambda, codes + 64 * b);
    }
}

struct trellis_result trellis_quantise(const float *dct, size_t blocks, double step, double lambda,
                                       int16_t *codes)
{
    struct trellis_result r = {0};
    round_all(dct, blocks, step, codes);
    struct counts n = count_symbols(codes, blocks);
    struct costs c = costs_of(&n, &r.bits);
    for (int round = 0; round < ROUNDS && lambda > 0.0; round++) {
        choose_all(&c, dct, blocks, step, lambda, codes);
        n = count_symbols(codes, blocks);
        c = costs_of(&n, &r.bits);
    }
    for (size_t i = 0; i < 64 * blocks; i++) {
        const double d = (double)dct[i] - step * codes[i];
        r.distortion += d * d;
    }
    return r;
}
