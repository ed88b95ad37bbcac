// sight.h - how a frame shows the world: the ray of a pixel, the pixel of a point (viewport.h)
#ifndef VIEWER_SIGHT_H
#define VIEWER_SIGHT_H

#include "app/frame_request.h"

#include <relume/relight/viewport.h>

// Of a captured picture; a slab's as it looks from `eye`.
struct relume_viewport sight_of_picture(const struct app_file *file, struct relume_vec3 eye);
// Of a frame; `eye`, of a slab, is the free eye or where the camera of the view stands. False where
// the eye sees nothing.
bool sight_of_frame(struct relume_viewport *out, const struct frame_request *request,
                    struct relume_vec3 eye);
// Of the frame as the app is now; false also for the views of a slab, whose cameras it does not
// know.
bool sight_of_app(struct relume_viewport *out, const struct app *app);

#endif
