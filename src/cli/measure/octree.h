// octree.h - triangles as cells of an octree, for rays that may be wrong by a cell: what
// reflections were traced with where no ray tracer was at hand (Meseth 2008, 11.4)
#ifndef MEASURE_OCTREE_H
#define MEASURE_OCTREE_H

#include "shape/mesh/mesh.h"

// Never changes. Thread-safety: safe.
typedef struct octree octree;

// Cells of the longest side over 2^depth; depth in [1, 10]. RELUME_ENOMEM.
relume_status octree_create(octree **out, const struct mesh *mesh, int depth);
void octree_destroy(octree **o);
size_t octree_bytes(const octree *o);
double octree_cell(const octree *o);  // the side of the finest

struct octree_hit {
    double distance;    // to where the ray enters the cell
    double side;        // of the cell
    vec3 normal;        // unit, the mean of what is in it, each triangle by its area there
    uint32_t material;  // that covers most of it
};
// The first cell with triangles in it along `direction` (unit) from `origin`. `cone`: how wide the
// ray is, over its length; cells are not finer than it. False when there is none.
bool octree_trace(struct octree_hit *out, const octree *o, vec3 origin, vec3 direction,
                  double cone);

#endif
