// blend.h - pictures of one sphere are joined band by band (Burt, Adelson 1983; Brown, Lowe 2007,
// section 7)
//
// Each place of a panorama (longitude and latitude) belongs to one picture. What is coarse in the
// pictures goes over into the neighbour's slowly, what is fine at once: steps of brightness show
// no seam, and what moved is not seen twice. Linear in the pictures, with weights that follow from
// the owners alone and sum to one: pictures that agree come out as they are.
#ifndef MULTIVIEW_BLEND_H
#define MULTIVIEW_BLEND_H

#include <relume/base.h>

enum {
    BLEND_UNSEEN = 0x8000,    // added to an owner: beyond its rim, too; black in the end
    BLEND_PICTURES = 0x7fff,  // most of them
    BLEND_BANDS = 10,
};

struct blend_box {
    int x, y, width, height;  // may go on across the panorama's ends
};

struct blend {
    int width, height;      // pixels of the panorama
    int bands;              // [1, BLEND_BANDS]; 1: seams stay hard, each more: twice as coarse
    int pictures;           // [1, BLEND_PICTURES]
    uint16_t *owner;        // [width * height]
    struct blend_box *box;  // of each picture: what it shows of the panorama, and what lies around
};

// Take notice of the owners, all of which must be set. RELUME_ENOMEM. Free `box` with mem_free().
relume_status blend_begin(struct blend *b);

// Colours of a picture at columns x, x + 1, ... (modulo the width) of row y: red, green, blue and
// a value that is left alone. Beyond the picture's rim: what is nearest.
typedef void blend_fetch(float *rgba, const void *context, int picture, int x, int y, int n);

// Add a picture to `sums` [3 * width * height], which begin at zero. Same bits for any `threads`.
relume_status blend_add(float *sums, const struct blend *b, int picture, blend_fetch *fetch,
                        const void *context, int threads);

// After all: light is nowhere negative, and nobody's places are black.
void blend_finish(float *sums, const struct blend *b);

#endif
