// disparity.h - depth as whole steps of its inverse, which is what parallax goes by
#ifndef LOSSY_DISPARITY_H
#define LOSSY_DISPARITY_H

#include "format/lossy/lossy.h"

#include <relume/image.h>

// The words of a depth map, of one channel: `step` is in inverse units of length and becomes larger
// where the nearest depth has more than 65535 of them. Infinite depth stays so. RELUME_ENOMEM.
relume_status disparity_encode(struct lossy_words *out, float *step,
                               const struct relume_image *depth);
// Into the pixels of `depth`. RELUME_EDAMAGED when they are not the words of such a map.
relume_status disparity_decode(struct relume_image *depth, const struct lossy_words *words,
                               float step);

#endif
