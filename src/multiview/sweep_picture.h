// sweep_picture.h - photographs as sweep.h wants them
#ifndef MULTIVIEW_SWEEP_PICTURE_H
#define MULTIVIEW_SWEEP_PICTURE_H

#include <relume/image.h>

// How many pixels of `width` become one so that at most `most` are left.
int sweep_factor(int width, int most);
// Linear `image` -> out[channel][height / factor][width / factor], coded by the square root,
// clipped to [0, 1].
void sweep_picture(uint8_t *out, const struct relume_image *image, int factor);

#endif
