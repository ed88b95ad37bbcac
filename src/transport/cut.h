// cut.h - pictures of a few hundred pixels of what surrounds a place, drawn from trees of points
#ifndef TRANSPORT_CUT_H
#define TRANSPORT_CUT_H

#include "transport/hierarchy.h"

#include <stdbool.h>

// Pixels are squares of the disc that the directions around the normal are projected on (Nusselt),
// so that what a matte surface shows of each goes by its area within the disc.
enum { CUT_LEAST = 4, CUT_MOST = 48 };

struct cut_pixel {
    float direction[3];  // of its middle, in the frame of the place
    float inside;        // the part of it within the disc
    float share;         // of what a matte surface shows; all of them add up to 1
};
struct cut_view {
    int side;
    struct cut_pixel pixel[CUT_MOST * CUT_MOST];
};
void cut_view_create(struct cut_view *out, int side);

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

// Where the picture is taken from.
struct cut_place {
    float at[3], frame[3][3];  // unit: two across, and the normal
    const struct cut_view *view;
};
void cut_place_at(struct cut_place *out, const struct cut_view *view, vec3 at, vec3 normal);
vec3 cut_direction(const struct cut_place *place, const struct cut_pixel *pixel);

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
