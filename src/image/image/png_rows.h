// png_rows.h - the rows of a PNG file, filtered and deflated on several threads
#ifndef IMAGE_PNG_ROWS_H
#define IMAGE_PNG_ROWS_H

#include "image/image/picture.h"

// One after the other they are a zlib stream. The same bytes for any number of threads.
struct png_piece {
    uint8_t *data;  // [size]
    size_t size;
};
// Makes pieces[count] of samples of 1 or 2 bytes in the machine's order. `effort` is zlib's level.
// RELUME_ENOMEM.
relume_status png_rows_deflate(struct png_piece **out, size_t *count,
                               const struct picture_array *array, int effort, int threads);
void png_rows_destroy(struct png_piece **pieces, size_t count);

#endif
