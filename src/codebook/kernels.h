// kernels.h - the inner loops of the search for the nearest code, one struct per instruction set
//
// Codes stand in tiles of four, points in blocks, both with the dimension outside, so that a loop
// over lanes is a loop over neighbours in memory.
#ifndef CODEBOOK_KERNELS_H
#define CODEBOOK_KERNELS_H

#include <relume/base.h>

enum { TILE = 4, BLOCK = 24 };

struct nearest_kernels {
    const char *name;
    // For every point of points[dim][BLOCK]: the score half[t][l] - point . codes[t][.][l] of all
    // codes in single precision, in any order of sums; `best` is the lowest, `tile` where it is,
    // `second` the lowest score of all other tiles (+inf when there is none).
    void (*scan)(const float *points, const float *codes, const float *half, int tiles, int dim,
                 float best[BLOCK], float second[BLOCK], int32_t tile[BLOCK]);
    // Squared distances of one point to the codes of a tile, summed in double precision from the
    // first component to the last: equal bits in every set.
    void (*measure)(double distance[TILE], const float *point, const float *tile, int dim);
};
extern const struct nearest_kernels nearest_kernels_c;     // the reference
extern const struct nearest_kernels nearest_kernels_avx2;  // AVX2, FMA

// The fastest that this CPU runs without the features `cpu_off`.
const struct nearest_kernels *nearest_kernels_choose(unsigned cpu_off);

#endif
