// kernels.h - every inner loop that is written for more than one instruction set
//
// A set is a row of one table (kernels.c): a new set is a file and a row, and names the loops that
// it does not make faster from the row below. `make bench` and tests/kernels go through the rows.
#ifndef KERNEL_KERNELS_H
#define KERNEL_KERNELS_H

#include <relume/base.h>

// Relighting: out[i] = bias + sum_k weights[k] * planes[k][i] for i in [0, n), added in the order
// of k. Plain C rounds products and sums; every other set fuses them, with equal bits in each, and
// no pixel's bits depend on where a run begins.
struct dot_kernels {
    void (*bytes)(float *out, size_t n, float bias, const uint8_t *const *planes,
                  const float *weights, int count);
    void (*words)(float *out, size_t n, float bias, const uint16_t *const *planes,
                  const float *weights, int count);
    void (*halves)(float *out, size_t n, float bias, const uint16_t *const *planes,
                   const float *weights, int count);
    void (*floats)(float *out, size_t n, float bias, const float *const *planes,
                   const float *weights, int count);
};

// The search for the nearest code. Codes stand in tiles of four, points in blocks, both with the
// dimension outside, so that a loop over lanes is a loop over neighbours in memory.
enum { TILE = 4, BLOCK = 48 };

struct nearest_kernels {
    // For every point of points[dim][BLOCK]: the score half[t][l] - point . codes[t][.][l] of all
    // codes in single precision, in any order of sums; `best` is the lowest, `tile` where it is,
    // `second` the lowest score of all other tiles (+inf when there is none).
    void (*scan)(const float *points, const float *codes, const float *half, int tiles, int dim,
                 float best[BLOCK], float second[BLOCK], int32_t tile[BLOCK]);
    // Squared distances of one point to the codes of a tile, summed in double precision from the
    // first component to the last: equal bits in every set.
    void (*measure)(double distance[TILE], const float *point, const float *tile, int dim);
};

// Pixels of bytes to planes of floats, these to waiting numbers, and those to codes: equal bits in
// every set.
struct unpack_kernels {
    // r[i] = in[3 i] / 255 and so on for i in [0, n), rounded once
    void (*thirds)(const uint8_t *in, size_t n, float *r, float *g, float *b);
    // out[i] = in[i] * a + b cut off at 0 and 255, towards zero
    void (*codes)(const uint16_t *in, size_t n, float a, float b, uint8_t *out);
    // out[i] = (in[i] - least) * scale + 0.5 towards zero; 0 where that is negative or not a
    // number. It is below 65536 elsewhere.
    void (*words)(const float *in, size_t n, float least, float scale, uint16_t *out);
    // The extremes of in[i] and of what they were; numbers that are none count for nothing.
    void (*range)(const float *in, size_t n, float *min, float *max);
};

// The chromatic sum of the eye's pattern.
struct psf_kernels {
    // out[i] = a[i] + t (b[i] - a[i])
    void (*mix)(float *out, const float *a, const float *b, float t, int n);
    // out[c][i] += rgb[c] * line(at + i * scale), linear between texels; at >= 0, scale in
    // (0.5, 1.6], and line can be read up to 16 texels beyond the last one that counts.
    void (*spread)(float *const out[3], int n, const float *line, float at, float scale,
                   const float rgb[3]);
    // The same with one channel.
    void (*spread_one)(float *out, int n, const float *line, float at, float scale, float weight);
};

// Rotations between constraints, of a block of places: matrices element by element, rows first.
// Equal bits in every set.
enum { TURN_BLOCK = 64 };
struct turn_kernels {
    // m = sum_n w_n M_n / sum_n w_n, w_n = 1 / d^2 of the distance from the place to
    // constraint[n][0..2], d at least `least`; M_n is constraint[n][3..11]
    void (*sum)(float m[9][TURN_BLOCK], const float place[3][TURN_BLOCK],
                const float (*constraint)[12], int n, float least);
    // the rotation nearest to each matrix, in its place; of 0 the identity
    void (*rotation)(float m[9][TURN_BLOCK]);
};

struct kernels {
    const char *name;  // as RELUME_CPU has it
    unsigned needs;    // RELUME_CPU_* bits
    const struct dot_kernels *dot;
    // out[i] = table[index[i]]
    void (*look_up)(uint32_t *out, size_t n, const uint16_t *index, const uint32_t *table);
    const struct nearest_kernels *nearest;
    const struct unpack_kernels *unpack;
    const struct psf_kernels *psf;
    const struct turn_kernels *turn;
    const struct lsq_kernels *lsq;  // core/kernel/lsq_kernels.h
};

// The fastest set that this CPU runs without the features `cpu_off`; ~0u: plain C, the reference.
const struct kernels *kernels_choose(unsigned cpu_off);

// What the rows are made of.
extern const struct dot_kernels dot_c, dot_avx2, dot_avx512, dot_neon;
void look_up_c(uint32_t *out, size_t n, const uint16_t *index, const uint32_t *table);
void look_up_avx2(uint32_t *out, size_t n, const uint16_t *index, const uint32_t *table);
void measure_avx2(double distance[TILE], const float *point, const float *tile, int dim);
extern const struct nearest_kernels nearest_c, nearest_avx2, nearest_avx512, nearest_neon;
void words_c(const float *in, size_t n, float least, float scale, uint16_t *out);
void range_c(const float *in, size_t n, float *min, float *max);
extern const struct unpack_kernels unpack_c, unpack_avx2, unpack_neon;
extern const struct psf_kernels psf_c, psf_avx2, psf_avx512;
extern const struct turn_kernels turn_c, turn_avx2, turn_avx512;

#endif
