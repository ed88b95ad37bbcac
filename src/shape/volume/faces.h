// faces.h - the lines of a surface on the faces of boxes, shared by neighbours, and their loops
#ifndef ISOSURFACE_FACES_H
#define ISOSURFACE_FACES_H

#include "shape/volume/block.h"
#include "shape/volume/loops.h"

// Samples of a block, in rows as wide as its words of bits, and the edges that begin at them.
enum {
    FACE_ROW = 32,
    FACE_SAMPLES = FACE_ROW * BLOCK_POINTS * BLOCK_POINTS,
    FACE_NODES = 3 * FACE_SAMPLES
};

// The owners in the block beyond each face, 2 axis + (0 lower, 1 higher); NULL: there is nothing of
// the surface on that face, or no block.
struct neighbours {
    const box_owner *owner[6];
    bool alone[6];  // it is one box
};

// Of one thread. Nodes are edges between neighbouring samples of a block.
struct faces {
    const struct signs *g;
    const struct block *block;
    const struct neighbours *beyond;
    bool share;
    int16_t next[FACE_NODES];   // the node that follows; -1: none
    uint8_t sides[FACE_NODES];  // faces of the box that it lies on; 0: not touched
    uint64_t placed[(FACE_NODES + 63) / 64];
    struct place place[FACE_NODES];  // of the block, where it is placed
    int touched;
    int16_t node[LOOP_MOST];  // [touched]
    size_t ambiguous;         // counted on, each face once
    struct loop loop;
};

void faces_begin(struct faces *f, const struct signs *g, bool share);
void faces_begin_block(struct faces *f, const struct block *b, const struct neighbours *beyond);
// All lines on the faces of a box of the block.
void faces_draw(struct faces *f, const struct box *box);
// Take the next loop of them into `f->loop`; false when there is none.
bool faces_loop(struct faces *f);

#endif
