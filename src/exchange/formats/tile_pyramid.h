// tile_pyramid.h - planes cut into tiles at full size, at half of it, at a quarter, ...
#ifndef EXCHANGE_TILE_PYRAMID_H
#define EXCHANGE_TILE_PYRAMID_H

#include <relume/image.h>

// Largest number of files that one tile becomes.
enum { TILE_FILES = 2 };

// A level: level 0 has the full size, each next one half of it, rounded up.
struct tile_level {
    int number;
    int width, height;  // pixels
    int columns, rows;  // of tiles
    const float *const
        *plane;  // [planes][height][width]; means of 2 x 2 pixels of the level before
};

struct tile {
    const struct tile_level *level;
    int column, row;
    struct relume_rect at;  // in pixels of the level, with the overlap
};

// Contents of a file; `bytes` is NULL for a file that is left out.
struct tile_file {
    uint8_t *bytes;  // freed by mem_free
    size_t size;
};

struct tile_pyramid {
    const float *const *plane;  // [planes][height][width]: level 0
    int planes;
    int width, height;
    int levels;
    int side;     // of a tile without its overlap, in pixels
    int overlap;  // pixels that a tile shares with each neighbour
    int threads;
    void *user;
    // Encodes a tile into files[TILE_FILES], which are zeroed.
    // Thread-safety: called from several threads at once, one tile each.
    relume_status (*encode)(void *user, const struct tile *tile, struct tile_file *files);
    // Saves file `number` of a tile. Called for all first files of a level, then all second ones,
    // each row by row, one at a time.
    relume_status (*save)(void *user, const struct tile *tile, int number,
                          const struct tile_file *file);
};

// Encodes and saves all tiles, from level 0 on. Holds one level and the files of its tiles in
// memory. RELUME_ENOMEM, or the first error of `encode` or `save`.
relume_status tile_pyramid_write(const struct tile_pyramid *pyramid);

// Copies the pixels of one plane that a tile covers to `to`, [tile->at.height][tile->at.width].
void tile_copy(float *to, const struct tile *tile, int plane);

#endif
