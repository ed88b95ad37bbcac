// tile_layer.h - a large view in its own pixels: tiles of the level that the frame asks for, over
// all of it at a coarser one
#ifndef VIEWER_TILE_LAYER_H
#define VIEWER_TILE_LAYER_H

#include "app/frame_request.h"
#include "draw/draw.h"
#include "relit/gl_relighter.h"
#include "relit/tile_map.h"

// Zeroed there are no tiles.
struct tile_layer {
    struct gl_relighter relighter;  // of the tiles, by number
    const struct tile_map *map;     // NULL: none
    const struct target **tile;     // [tiles]: relit; NULL where not needed or not there yet
    size_t tile_bytes;              // graphics memory of a tile, about; 0: unknown
};

// Tiles come from `source`; they are relit as `view`, the relighter of the whole view, does, which
// shares its budget. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status tile_layer_create(struct tile_layer *l, const struct code_source *source,
                                const struct tile_map *map, struct gl_relighter *view);
void tile_layer_destroy(struct tile_layer *l);
// Relights the tiles that the frame shows finer than the view as a whole. Errors of
// gl_relighter_view.
relume_status tile_layer_relight(struct tile_layer *l, const struct frame_request *q,
                                 const struct relume_light *lights, int n);
// Draws the whole view, then the tiles, with the program of draw_picture.
void tile_layer_draw(const struct tile_layer *l, const struct program *picture,
                     const struct frame_area *area, const struct target *view);

#endif
