// views.h - codes of a view at any level, rectangles of them, and the writer
#ifndef PACK_VIEWS_H
#define PACK_VIEWS_H

#include "format/coder/coding.h"

#include <relume/pack.h>

// Large views are kept at half, a quarter, ... of their size too, so that a smaller picture of all
// is soon there.
enum { RELUME_MOST_LEVELS = 16 };

// Most bytes of notes that a file holds itself.
enum { RELUME_PACK_MOST_NOTES = 1 << 26 };

// True when damaged tiles are shown as nothing, and warned about.
bool relume_pack_keeps_going(const relume_pack *pack);

// From now on the views of an open file are that part of them: info, geometry, codes, depth, masks
// and models. Reduced levels are given up. Notes stay those on the whole. RELUME_EINVAL for a part
// that does not lie within the views, RELUME_EUNFIT for panoramas and slabs around an object.
relume_status relume_pack_crop(relume_pack *pack, const struct relume_rect *part);

// Those of a rectangle of it alone, of which no more is read than the rows of the file that hold
// it, or tiles. They belong to the caller, but for codebooks, which stay until the pack's are
// dropped. RELUME_EINVAL where the rectangle does not lie within the view.
relume_status relume_pack_codes_part(struct relume_codes_part *out, relume_pack *pack, int view,
                                     const struct relume_rect *rect);
// The size of a view at a level: 0 is the view itself, 1 .. info.levels are reduced.
void relume_pack_level_size(int *width, int *height, const relume_pack *pack, int level);
// A rectangle of a view at a level, of whose pixels it is counted; else as relume_pack_codes_part.
relume_status relume_pack_codes_level(struct relume_codes_part *out, relume_pack *pack, int view,
                                      int level, const struct relume_rect *rect);
// The same at a level, as relume_pack_level_size: of each pixel what lies beside its middle.
relume_status relume_pack_depth_level(struct relume_image *out, relume_pack *pack, int view,
                                      int level);

// Channels of a model of moving shadows (relight/shadow.h).
enum {
    RELUME_SHADOW_THICK = 0,     // world units behind the surface, along the axis of the view or
                                 // away from its eye, in which light is stopped; above 0
    RELUME_SHADOW_COLOUR = 1,    // r, g, b of luminance 1, or black
    RELUME_SHADOW_MATTE = 4,     // a, then b in the world
    RELUME_SHADOW_CHANNELS = 8,  // in all
};

// Channels of a model of moving highlights.
enum {
    RELUME_GLOSS_COLOUR = 0,     // r, g, b: of the matte surface, or what a metal shines like;
                                 // linear, 0 or more
    RELUME_GLOSS_NORMAL = 3,     // x and y of a unit vector towards the viewer
    RELUME_GLOSS_ROUGHNESS = 5,  // glTF's, 0 to 1
    RELUME_GLOSS_SHINE = 6,      // reflectance at normal incidence; below 0: a metal
    RELUME_GLOSS_SHARE = 7,      // of that which counts, 0 or more
    RELUME_GLOSS_CHANNELS = 8,   // in all
};

#endif
