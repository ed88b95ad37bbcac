// warp.h - small pictures whose pixels lie where a surface throws light from
#ifndef TRANSPORT_WARP_H
#define TRANSPORT_WARP_H

#include "world/transport/cut_view.h"

#include <stdbool.h>

// Coordinates over pixels, by pieces between lines: `before` at the line, `per` unit from there on.
enum { WARP_BINS = 28, WARP_LINES = 16 };
struct warp_axis {
    float before[WARP_LINES], per[WARP_LINES];
};
// Columns are strips of the disc of directions, u from -1 to 1. Each has its own rows, over v by
// the disc's height there, from -1 to 1.
struct warp {
    struct cut_view view;
    float line[2][WARP_LINES + 1];
    unsigned char piece[2][WARP_BINS];  // which one an even part of the way begins in
    struct warp_axis column, row[CUT_MOST];
    float middle[CUT_MOST];                // of columns
    float answer[CUT_MOST * CUT_MOST][3];  // what a pixel's light is multiplied by
};

// What a surface returns of light of 1 from a direction (unit), over all that a white matte one
// returns: pi times its reflectance.
typedef void warp_answer(float rgb[3], const void *context, vec3 towards);

// Divide the disc of a place into `side` x `side` pixels of equal weight, and let the place see
// them: its picture is turned so that `mirrored`, where a mirror would show, is upwards. False, and
// nothing is changed: the surface returns nothing.
bool warp_create(struct warp *out, struct cut_place *place, int side, vec3 mirrored,
                 warp_answer *answer, const void *context);

// The pixels that a place of the disc is shared among, and what an area of 1 there covers of each.
struct warp_parts {
    int pixel[4];
    float weight[4];
};
void warp_parts(struct warp_parts *out, const struct warp *warp, float u, float v);
// The area of a pixel there.
float warp_area(const struct warp *warp, float u, float v);
// Columns, and rows of one of them, whose middles may be nearer than `reach`.
void warp_columns(int out[2], const struct warp *warp, float u, float reach);
void warp_rows(int out[2], const struct warp *warp, int column, float v, float reach);

#endif
