// levels.h - the planes of a view as a pyramid of tiles
//
// NAME/v0/L_X_Y.bin: level L (0 is the full size, each next one half of it, rounded up), column X,
// row Y of tiles. Little-endian: how many pictures, as 32 bits, the bytes of each, likewise, then
// the pictures, JPEG of three planes each as red, green and blue; L_X_Y.avif.bin: likewise, each
// as AVIF unless JPEG is smaller.
#ifndef PUBLISH_LEVELS_H
#define PUBLISH_LEVELS_H

#include "exchange/foreign/planes.h"
#include "exchange/formats/sheet.h"
#include "site/publish/site.h"

enum { LEVELS_TILE = 512, LEVELS_MOST = 24 };
// Without a wish, of linear files whose shadows stay, and of others.
enum { PUBLISH_USUAL_PLANES = 45, PUBLISH_MOST_PLANES = 90 };

// How all views of a file are coded.
struct levels {
    int planes, count;                // of levels
    double step;                      // in units of the picture's error
    bool guided;                      // planes are divided by what guide.h says
    const double *minimum, *maximum;  // [planes], of all views
    float *scale, *offset;            // [planes], found while writing: C (guided: u) = code * scale
                                      // + offset
    enum relume_publish_layers layers;
    int threads;
};

// Of views of that size: the last level has at most 128 pixels a side, 64 where there are several
// views, of which a page shows four at once.
int levels_count(int width, int height, int views);

// Write the pyramid of `p` into the folder `name` of the site. bytes[level] grows by what was
// written, avif[level] by what of it is AVIF. With `codes`, [planes][height][width], what a reader
// decodes of level 0.
relume_status levels_write(const struct site *site, const char *name, const struct planes *p,
                           const struct levels *l, uint64_t *bytes, uint64_t *avif, uint8_t *codes);
// The same of level 0 alone, of which nothing is written.
relume_status levels_try(const struct planes *p, const struct levels *l, uint64_t *bytes,
                         uint8_t *codes);
// The file of a tile, of the pictures of some sheets; the caller frees it. RELUME_ENOMEM.
relume_status levels_join(const struct sheet_result *sheet, int sheets, uint8_t **out,
                          size_t *size);

#endif
