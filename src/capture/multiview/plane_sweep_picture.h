// plane_sweep_picture.h - photographs as plane_sweep.h wants them
#ifndef MULTIVIEW_PLANE_SWEEP_PICTURE_H
#define MULTIVIEW_PLANE_SWEEP_PICTURE_H

#include <relume/image.h>

// How many pixels of `width` become one so that at most `most` are left.
int plane_sweep_factor(int width, int most);
// Linear `image` -> out[channel][height / factor][width / factor], coded by the square root,
// clipped to [0, 1].
void plane_sweep_picture(uint8_t *out, const struct relume_image *image, int factor);

#endif
