// correlate.h - how well a block of one picture fits another at a shift
#ifndef HDR_CORRELATE_H
#define HDR_CORRELATE_H

#include <relume/image.h>

// Pixels.
struct rectangle {
    int x, y, width, height;
};

// The part of `r` inside of another rectangle; width or height 0 when there is none.
struct rectangle rectangle_clip(struct rectangle r, int x, int y, int width, int height);

struct moments {
    double a, aa;  // sum of samples, and of squares
};

// Over the pixels and channels of a rectangle inside of the image. Images have three channels.
struct moments block_moments(const struct relume_image *image, const struct rectangle *r);

// Normalised correlation of the anchor's rectangle, whose moments are known, with the image at
// shift (dx, dy), one mean for all channels removed. 0 when either shows nothing but noise;
// -INFINITY when less than a quarter of it lies inside of the image.
double block_correlation(const struct relume_image *anchor, const struct relume_image *image,
                         const struct rectangle *r, struct moments known, int dx, int dy);

// In place, with the kernel 0 -1/4 0, -1/4 2 -1/4, 0 -1/4 0.
relume_status sharpen(struct relume_image *image, int threads);

#endif
