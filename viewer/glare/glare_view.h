// glare_view.h - how large a pixel of the frame is to the eye, and what of the pattern fits it
#ifndef VIEWER_GLARE_VIEW_H
#define VIEWER_GLARE_VIEW_H

#include "app/app.h"

// Horizontal field of view that a perspective frame with the same pixels in its middle would have,
// degrees in [0.01, 170]. Pictures without perspective are looked at as a screen is:
// GLARE_SCREEN_DEG across the whole picture.
#define GLARE_SCREEN_DEG 45.0
double glare_fov_deg(const struct app *app);

// Magnification and veil as the app wants them, as far as they fit: a veil that would reach further
// than the frame is wide is left out, and a pattern of that geometry gets no wider than the frame.
struct relume_glare_params glare_view(const struct app *app,
                                      const struct relume_psf_geometry *pattern);

#endif
