// structure.h - what stays of a picture when exposure and light change: its edges
#ifndef HDR_STRUCTURE_H
#define HDR_STRUCTURE_H

#include <relume/image.h>

// Root of the mean of the channels, one channel: dark detail counts as bright does.
relume_status structure_luma(struct relume_image *out, const struct relume_image *image,
                             int threads);
// Gradient magnitude of a luma, less its local mean and over its local deviation (17 x 17 pixels):
// a lamp that moves or an exposure that changes scales edges, here by about the same factor above
// and below. Fewer than 0.1 of the picture's own deviation count as noise.
relume_status structure_make(struct relume_image *out, const struct relume_image *luma,
                             int threads);

#endif
