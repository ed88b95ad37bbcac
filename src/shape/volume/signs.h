// signs.h - which samples of a volume are inside, one bit each; crossings are where bits differ
//
// Sample (x, y, z) is bit x of row z * height + y. What lies between two neighbouring samples of
// different bits holds one vertex; the edge is named by its lower sample and its axis.
#ifndef ISOSURFACE_SIGNS_H
#define ISOSURFACE_SIGNS_H

#include "core/base/thread.h"
#include "shape/volume/volume.h"

struct signs {
    const relume_volume *volume;
    int size[3];
    int words;  // of 64 samples, of a row
    size_t rows;
    float threshold;
    uint64_t *bits;  // [rows][words]; beyond the end of a row stands its last bit
    int threads;
    struct thread_told told;  // of the mesh that is made
};

// All layers of a round, which is that share of a mesh; false: somebody asked to stop.
bool signs_round(const struct signs *g, size_t layers,
                 void (*body)(void *context, size_t item, int worker), void *context, double from,
                 double to);

// RELUME_ENOMEM.
relume_status signs_create(struct signs *g, const relume_volume *volume, float threshold,
                           int threads);
void signs_free(struct signs *g);

static inline const uint64_t *signs_row(const struct signs *g, int y, int z)
{
    return g->bits + ((size_t)z * (size_t)g->size[1] + (size_t)y) * (size_t)g->words;
}

static inline bool signs_inside(const struct signs *g, int x, int y, int z)
{
    return signs_row(g, y, z)[x >> 6] >> (x & 63) & 1;
}

// A word of a row moved on by one sample.
static inline uint64_t signs_next(const uint64_t *row, int w, int words)
{
    return row[w] >> 1 | (w + 1 < words ? row[w + 1] << 63 : row[w] & (uint64_t)1 << 63);
}

// Bits that are set. Without the processor's own instruction the compiler would call a function.
static inline int signs_count(uint64_t word)
{
    word -= word >> 1 & 0x5555555555555555;
    word = (word & 0x3333333333333333) + (word >> 2 & 0x3333333333333333);
    word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0f;
    return (int)(word * 0x0101010101010101 >> 56);
}

// Which of the 64 edges along `axis` from word `w` of a row on are crossed.
static inline uint64_t signs_crossed(const struct signs *g, int axis, int y, int z, int w)
{
    const uint64_t *row = signs_row(g, y, z);
    if (axis == 0)
        return row[w] ^ signs_next(row, w, g->words);
    if ((axis == 1 ? y : z) + 1 == g->size[axis])
        return 0;
    const uint64_t own = (size_t)w + 1 < (size_t)g->words || !(g->size[0] & 63)
                             ? ~(uint64_t)0
                             : ((uint64_t)1 << (g->size[0] & 63)) - 1;
    return (row[w] ^ signs_row(g, y + (axis == 1), z + (axis == 2))[w]) & own;
}

// The vertex of a crossed edge: its place, and the unit direction in which values fall.
struct place {
    float position[3], normal[3];
};
// In samples, without the spacing of the volume.
struct place signs_place(const struct signs *g, int axis, int x, int y, int z);

// The vertices of a mesh: those of `used` edges, or of all that are crossed where that is NULL.
// `used` has words as the bits, three to each of theirs: of axis 0, 1, 2.
struct numbering {
    const uint64_t *used;  // [rows][3][words]
    uint32_t *first;       // [rows][3]: the number of the first vertex of a row and an axis
    size_t count;
};
// RELUME_ENOMEM, RELUME_ELIMIT.
relume_status numbering_create(struct numbering *n, const struct signs *g, const uint64_t *used);
void numbering_free(struct numbering *n);
// Fill the arrays of `out`, of `count` vertices.
void numbering_put(const struct numbering *n, const struct signs *g, struct relume_mesh *out);

static inline uint64_t numbering_word(const struct numbering *n, const struct signs *g, int axis,
                                      int y, int z, int w)
{
    if (!n->used)
        return signs_crossed(g, axis, y, z, w);
    const size_t row = (size_t)z * (size_t)g->size[1] + (size_t)y;
    return n->used[(3 * row + (size_t)axis) * (size_t)g->words + (size_t)w];
}

#endif
