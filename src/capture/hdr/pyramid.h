// pyramid.h - pictures halved again and again, for coarse-to-fine alignment
#ifndef HDR_PYRAMID_H
#define HDR_PYRAMID_H

#include <relume/image.h>

enum { PYRAMID_LEVELS = 16 };

struct pyramid {
    int levels;
    struct relume_image level[PYRAMID_LEVELS];  // 0 is the picture's own size
};

// Halve `image` (means of 2 x 2 pixels; an odd last row or column counts as its neighbour too).
relume_status pyramid_halve(struct relume_image *out, const struct relume_image *image,
                            int threads);
// Halved copies until the longer side is at most `side` pixels; level 0 is a copy too.
relume_status pyramid_make(struct pyramid *out, const struct relume_image *image, int side,
                           int threads);
void pyramid_free(struct pyramid *pyramid);

static inline int pyramid_longer_side(const struct relume_image *image)
{
    return image->width > image->height ? image->width : image->height;
}

#endif
