// sight.h - two pictures as an eye's channels see them: opponent colours weighted by the contrast
// sensitivity, in bands of fineness and direction that add up to the whole (after Watson's cortex
// transform, 1987)
#ifndef COMPARE_SIGHT_H
#define COMPARE_SIGHT_H

#include "core/math/fft2d.h"
#include "image/compare/jnd.h"

#include <relume/image/jnd.h>

// Bands of an octave around 0.5, 1, ... 32 cycles per degree; the first one holds all that is
// coarser, the last one all that is finer
enum { SIGHT_BANDS = 7, SIGHT_DIRECTIONS = 6 };

struct sight {
    const struct relume_image *image[2];
    const float *mask;  // or NULL
    int width, height;  // of the images
    int wide, high;     // of what is transformed
    double ppd, white;
    int threads;
    bool unmasked;
    fft2d *fft;
    float *spectrum[2], *work;
    float *band[2];  // [height][width]: the band of both images, JND
    float *over;     // [height][width]: their difference over its threshold
    float *scratch;  // [2][height][width]
};

// RELUME_EINVAL where images or params are out of their ranges (jnd.h), RELUME_ENOMEM. Borrows all.
relume_status sight_create(struct sight *s, const struct relume_image *image,
                           const struct relume_image *reference, const struct relume_jnd_params *p);
void sight_destroy(struct sight *s);

// Look at both images in one channel.
void sight_look(struct sight *s, enum relume_opponent channel);
// `over` becomes the difference in a band over its threshold; direction -1: all.
void sight_difference(struct sight *s, int band, int direction);

// The share of a band, and of a direction in it, at (x, y) cycles per degree; of all bands, and all
// directions, they sum to 1.
double sight_band_share(int band, double x, double y);
double sight_direction_share(int direction, double x, double y);

#endif
