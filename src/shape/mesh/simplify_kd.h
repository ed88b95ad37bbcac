// simplify_kd.h - space cut into cells that hold about as many triangles each
#ifndef MESH_SIMPLIFY_KD_H
#define MESH_SIMPLIFY_KD_H

#include "shape/mesh/simplify.h"

struct kd_node {
    int axis;
    double cut;
    int next[2];  // below the cut, from it on: a node, or ~ the number of a cell
};
struct kd {
    int count, nodes;
    struct kd_node *node;  // none: all is one cell
};
// Cells of at most about `most` triangles of the original, each cut where `share` of what it held
// lies below. RELUME_ENOMEM.
relume_status kd_create(struct kd *c, const struct simplify *s, size_t most, double share);
void kd_free(struct kd *c);
// The cell of a triangle: that of its middle.
int kd_find(const struct kd *c, const struct simplify *s, const uint32_t triangle[3]);

#endif
