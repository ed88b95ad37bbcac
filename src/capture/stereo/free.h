// free.h - one pixel whose reflectance is not known
#ifndef STEREO_FREE_H
#define STEREO_FREE_H

#include "capture/stereo/pixel.h"

// Normal, parts, `sure` and weights, from pixel->guess or, `around`, from the best of normals all
// around: metals need that, and shadows mislead it. False where it is too dark.
bool free_solve(struct stereo_pixel *pixel, bool around, struct stereo_scratch *scratch);

#endif
