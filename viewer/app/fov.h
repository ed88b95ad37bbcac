// fov.h - how wide the frame is to who looks at it
#ifndef VIEWER_FOV_H
#define VIEWER_FOV_H

#include "app/state.h"

// Horizontal field of view that a perspective frame with the same pixels in its middle would have,
// degrees in [0.01, 170]. Pictures without perspective are looked at as a screen is:
// APP_SCREEN_DEG across the whole picture.
#define APP_SCREEN_DEG 45.0
double app_fov_deg(const struct app *app);

#endif
