// loops.h - a closed line of vertices on the faces of a box becomes triangles
#ifndef ISOSURFACE_LOOPS_H
#define ISOSURFACE_LOOPS_H

#include "shape/volume/signs.h"

// On the faces of a simple box of 16 samples are 204 lines, each crossed at most once.
enum { LOOP_MOST = 256 };

struct loop {
    int count;
    uint64_t key[LOOP_MOST];               // of its vertices
    const struct place *place[LOOP_MOST];  // where they are; not of three alone
    uint8_t faces[LOOP_MOST];              // of the box that each lies on, bits
};

// Triangles by vertices' keys, `count - 2` of them; the loop is used up.
void loop_cut(struct loop *loop, uint64_t (*out)[3]);

#endif
