// glare_view.h - what of an eye's pattern fits a frame
#ifndef VIEWER_GLARE_VIEW_H
#define VIEWER_GLARE_VIEW_H

#include "app/frame_request.h"

// Magnification and veil as the request wants them, as far as they fit: a veil that would reach
// further than the frame is wide is left out, and a pattern of that geometry gets no wider than the
// frame.
struct relume_glare_params glare_view(const struct frame_request *request,
                                      const struct relume_psf_geometry *pattern);

#endif
