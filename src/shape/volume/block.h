// block.h - a block of a grid, and the boxes that it is made of
//
// Along each axis a box is a dike: 2^l samples long, and beginning at a multiple of that. Two dikes
// of an axis are nested or apart. A box is simple when every line of samples in it, its faces
// included, is crossed at most once; so are all boxes in it.
#ifndef ISOSURFACE_BLOCK_H
#define ISOSURFACE_BLOCK_H

#include "shape/volume/signs.h"

enum { BLOCK_SIDE = 16, BLOCK_LEVELS = 5, BLOCK_POINTS = BLOCK_SIDE + 1 };

// Where it begins, in cells of its block, and the logarithms of its sides.
struct box {
    uint8_t at[3], level[3];
};

// Who covers a cell: 0 nobody yet, else 1 + the levels of a box in base 5. Dikes say where it
// begins.
typedef uint8_t box_owner;

static inline box_owner owner_of(const uint8_t level[3])
{
    return (box_owner)(1 + level[0] + BLOCK_LEVELS * (level[1] + BLOCK_LEVELS * level[2]));
}

static inline void owner_levels(uint8_t level[3], box_owner owner)
{
    const int code = owner - 1;
    level[0] = (uint8_t)(code % BLOCK_LEVELS);
    level[1] = (uint8_t)(code / BLOCK_LEVELS % BLOCK_LEVELS);
    level[2] = (uint8_t)(code / (BLOCK_LEVELS * BLOCK_LEVELS));
}

// Masks say which dikes are not simple: bit p of a mask of an axis x is the one that begins at p,
// of another axis the one on the line at x = p.
struct block {
    int side, levels;  // 2^levels samples
    int origin[3], cells[3];
    uint32_t row[BLOCK_POINTS * BLOCK_POINTS];                   // [z][y], bit x: inside
    uint32_t along_x[BLOCK_LEVELS][BLOCK_POINTS][BLOCK_POINTS];  // [level][z][y]
    uint32_t along_y[BLOCK_LEVELS][BLOCK_POINTS][BLOCK_SIDE];    // [level][z][begin]
    uint32_t along_z[BLOCK_LEVELS][BLOCK_POINTS][BLOCK_SIDE];    // [level][y][begin]
    box_owner owner[BLOCK_SIDE * BLOCK_SIDE * BLOCK_SIDE];       // [z][y][x], `side` of each
};

// The block `at` (in blocks of `side`) and its signs; nothing else yet.
void block_load(struct block *b, const struct signs *g, int side, const int at[3]);
// Its boxes, as owners: one alone where the whole block is simple (true), else what climbing finds.
bool block_climb(struct block *b);

static inline bool block_inside(const struct block *b, const int p[3])
{
    return b->row[p[2] * BLOCK_POINTS + p[1]] >> p[0] & 1;
}

static inline box_owner *block_owner(box_owner *owner, int side, int x, int y, int z)
{
    return owner + ((size_t)z * (size_t)side + (size_t)y) * (size_t)side + (size_t)x;
}

#endif
