// cut_view.h - the pixels of a small picture of what surrounds a place
#ifndef TRANSPORT_CUT_VIEW_H
#define TRANSPORT_CUT_VIEW_H

#include "core/math/vec.h"

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

// Where the picture is taken from.
struct warp;
struct cut_place {
    float at[3], frame[3][3];  // unit: two across, and the normal
    const struct cut_view *view;
    const struct warp *warp;  // of the view's pixels; NULL: they are squares
};
void cut_place_at(struct cut_place *out, const struct cut_view *view, vec3 at, vec3 normal);
vec3 cut_direction(const struct cut_place *place, const struct cut_pixel *pixel);

#endif
