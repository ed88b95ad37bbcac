// spread.h - points spread evenly over triangles, in the order of their cells
#ifndef TRANSPORT_SPREAD_H
#define TRANSPORT_SPREAD_H

#include "shape/mesh/mesh.h"

// It stands for a piece of the surface of the size of a cell.
struct spread_point {
    uint64_t cell;                 // its binary digits are those of x, y and z in turn (Morton)
    float position[3], normal[3];  // of the piece; the normal is unit, as the triangle is wound
    float area;
    uint32_t triangle;  // of a place near its middle
    float u, v;         // ... weights of the second and third corner
};
struct spread {
    struct spread_point *point;  // in ascending order of cells
    size_t count;
    int levels;  // a cell is so often halved
};

// About `wanted` points on the triangles of those numbers, at most 2^31; fewer where these have no
// extent. RELUME_ENOMEM.
relume_status spread_make(struct spread *out, const struct mesh *mesh, const uint32_t *triangle,
                          size_t count, size_t wanted);
void spread_free(struct spread *s);

#endif
