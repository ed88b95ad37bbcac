// pieces.h - what trees of points are made of: pieces of a captured scene, and of objects in it
#ifndef TRANSPORT_PIECES_H
#define TRANSPORT_PIECES_H

#include "world/transport/hierarchy.h"
#include "world/transport/points.h"

// Leaves of trees. Objects have two trees: of their points, and of the backs of those that light
// gets to from both sides.
enum { PIECES_SCENE = 1 << 15, PIECES_OBJECT = 1 << 12, PIECES_SIDES = 2 };

// Of each triangle of the scene its middle, and behind them of each block of the background, so far
// away that it is in the same direction from everywhere among scene and `objects` (NULL: there are
// none). RELUME_ENOMEM; mem_free frees them.
relume_status pieces_of_scene(struct piece **out, size_t *count, const struct scenery *c,
                              const struct mesh *objects);
// Of points one side, as many as these; NULL of none. RELUME_ENOMEM.
relume_status pieces_of_points(struct piece **out, const struct points *points, int side);

#endif
