// cut.h - pictures of a few hundred pixels of what surrounds a place, drawn from trees of points
#ifndef TRANSPORT_CUT_H
#define TRANSPORT_CUT_H

#include "world/transport/cut_view.h"
#include "world/transport/hierarchy.h"

#include <stdbool.h>

// How much of a pixel is covered, and that times what is sent.
struct cut_light {
    float covers, without[3], with[3], spare;
};
struct cut_cell {
    struct cut_light near, far;  // of the scene: what is nearest, and all behind it
    struct cut_light object;     // of objects: what is nearest
    float depth, object_depth;   // of what is nearest
    float far_depth;             // of the farthest behind it
    float covered;               // by objects, of what faces the place
    bool close, object_close;    // may be covered by points that are too near to be drawn
};

// Leaves of the tree that are larger than a pixel.
enum { CUT_LISTED = 256 };
struct cut_list {
    int count;
    uint32_t node[CUT_LISTED];
};

// Draw the points of a tree into zeroed cells of the place's view. The scene's points are seen from
// both sides, those of objects from their front. Leaves that are larger than a pixel are not drawn
// but listed, and mark what they may cover; what does not fit in the list is drawn.
void cut_scene(struct cut_cell *cells, struct cut_list *close, const struct hierarchy *h,
               const struct cut_place *place);
void cut_objects(struct cut_cell *cells, struct cut_list *close, const struct hierarchy *h,
                 const struct cut_place *place);
// The listed leaf nearest to a place, of those whose front a ray `towards` it sees (zero: of all),
// and how far it is; infinitely far where there is none.
float cut_nearest(uint32_t *node, const struct cut_list *close, const struct hierarchy *h, vec3 at,
                  vec3 towards);

#endif
