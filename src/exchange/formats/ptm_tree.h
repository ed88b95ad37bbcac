// ptm_tree.h - which plane of a JPEG-coded .ptm is predicted from which
//
// The format lets a plane be stored as its difference from any plane that is decoded before it, or
// from the inverse of one. What the planes take together is least for the least spanning tree of
// "stored by itself" and the planes, an edge being what one takes given the other (Motta and
// Weinberger 2001); it is grown from its root (Prim 1957), which is exact where steps are equal.
#ifndef EXCHANGE_PTM_TREE_H
#define EXCHANGE_PTM_TREE_H

#include "exchange/formats/ptm_parts.h"

struct ptm_tree {
    int reference[PTM_MOST_PLANES];  // plane of the file, -1: none
    bool inverted[PTM_MOST_PLANES];
    int turn[PTM_MOST_PLANES];   // when the plane is decoded
    int depth[PTM_MOST_PLANES];  // how many planes it follows from
};

// `step`: the quantiser's, of every plane of the file. Costs are estimated on some rows of blocks.
relume_status ptm_tree_grow(struct ptm_tree *out, const struct foreign *f, const int *step);

#endif
