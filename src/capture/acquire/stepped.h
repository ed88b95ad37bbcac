// stepped.h - the height of a surface that has steps, from its normals
#ifndef ACQUIRE_STEPPED_H
#define ACQUIRE_STEPPED_H

#include "capture/acquire/photometric.h"

#include <relume/capture/photometric.h>

// The slopes to the right (axis 0) and down (axis 1), at most STEEPEST; false where the normal is
// unknown.
#define STEEPEST 5.67f  // tan 80 degrees
bool slopes_of(float slope[2], const float normal[3]);

// As relume_height_integrate, in pixels and with any mean; `screen` above 0.
relume_status stepped_integrate(struct relume_image *out, const struct relume_image *normal,
                                const struct relume_height_params *params);

#endif
