// coarse.h - pictures of fewer pixels, and what is found by them for one of all pixels
#ifndef OBJECT_COARSE_H
#define OBJECT_COARSE_H

#include "core/math/bilinear.h"

#include <relume/image.h>

// The middle one of the places of each pixel of a picture of about `fewer` times fewer pixels along
// each side: `*out` is created. RELUME_ENOMEM.
relume_status coarse_places(struct relume_image *out, const struct relume_image *places, int fewer);
// A picture becomes one of no more pixels, each the mean of its part; of three channels.
void coarse_means(struct relume_image *image, int width, int height);
// Each pixel times `with` over `without`, of fewer pixels, between whose centres the quotient is
// bilinear; where `without` is 0 it is 1.
void coarse_multiply(struct relume_image *image, const struct relume_image *with,
                     const struct relume_image *without, enum edge columns, int threads);

#endif
