// hierarchy.h - points of surfaces as a tree of balls, each of which stands for all points in it
// and has their mean light (QSplat: Rusinkiewicz and Levoy 2000)
//
// A node has eight children, so that a processor looks at them together. All leaves lie on one
// level; where there are more points than leaves may be, a leaf holds several.
#ifndef TRANSPORT_HIERARCHY_H
#define TRANSPORT_HIERARCHY_H

#include "core/math/vec.h"

#include <relume/base.h>

#include <stddef.h>
#include <stdint.h>

struct piece {
    float place[3];
    float area[3];  // its area times its unit normal
};

// What a node sends: were there no objects, and as it is.
struct sent {
    float without[3], with[3];
};

enum { HIERARCHY_WAYS = 8, HIERARCHY_LEVELS = 8 };

// Children of one node. Number `k` of group `g` is node `HIERARCHY_WAYS * g + k`.
struct group {
    float x[HIERARCHY_WAYS], y[HIERARCHY_WAYS], z[HIERARCHY_WAYS];  // middle by area
    float radius[HIERARCHY_WAYS];  // of the ball about it; below 0: there is no such child
    // The sum of areas times normals, and half of what of the areas cancels in it: seen from
    // `d` its area is about |facing . d| + turned, exactly so for planes and spheres.
    float facing[3][HIERARCHY_WAYS], turned[HIERARCHY_WAYS];
    // Of the cone about all normals and of the ball: from where a step to the middle goes along
    // `facing` by more than cone times its length + edge, only backs are seen.
    float cone[HIERARCHY_WAYS], edge[HIERARCHY_WAYS];
};

// Zeroed: there are no points.
struct hierarchy {
    int levels;
    size_t first[HIERARCHY_LEVELS + 1];  // group of each level
    size_t leaves;
    struct group *groups;
    float *area;        // [nodes]
    struct sent *sent;  // [nodes]
    uint32_t *order;    // [pieces]: leaf by leaf
    size_t *begins;     // [leaves + 1] in `order`
};

// Of pieces with an area, at most `leaves` of them, a power of two. RELUME_ENOMEM; `out` is without
// points then.
relume_status hierarchy_create(struct hierarchy *out, const struct piece *pieces, size_t count,
                               size_t leaves, int threads);
void hierarchy_forget(struct hierarchy *h);
// The node of a leaf.
static inline size_t hierarchy_leaf(const struct hierarchy *h, size_t leaf)
{
    return HIERARCHY_WAYS * h->first[h->levels - 1] + leaf;
}
// All other nodes send the mean of what their leaves do, by area.
void hierarchy_light(struct hierarchy *h);

#endif
