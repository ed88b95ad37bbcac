// tile_map.h - a large view and its reduced levels as many small views, by one number
#ifndef VIEWER_TILE_MAP_H
#define VIEWER_TILE_MAP_H

#include "format/pack/views.h"

#include <relume/pack.h>

// Pixels of a side; of the file's own tiles a whole number.
enum { TILE_SIDE = 512 };
// Pixels beyond each side, where means and what is between pixels look.
enum { TILE_MARGIN = 2 };

// Those of levels 0 .. levels - 1 of view 0; none: it has no pyramid. Plain data.
struct tile_map {
    int levels;
    int width[RELUME_MOST_LEVELS], height[RELUME_MOST_LEVELS];
    int first[RELUME_MOST_LEVELS + 1];  // number of its first tile
};

struct tile {
    int level;
    struct relume_rect inner, rect;  // pixels of the level: without and with the margin
};

// The levels finer than the one that a view is known by: the first that so many bytes hold, half of
// them where there are tiles beside it; of planes above 64 megapixels one of at most 2. That is
// `levels`, 0 the view itself.
void tile_map_make(struct tile_map *map, const relume_pack *pack, size_t bytes);
struct tile tile_map_tile(const struct tile_map *map, int number);
// The number of the tile in that column and row.
int tile_map_number(const struct tile_map *map, int level, int column, int row);

#endif
