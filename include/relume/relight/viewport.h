// viewport.h - how a frame shows the world: the ray of a pixel, the pixel of a point, lights in
// view
#ifndef RELUME_VIEWPORT_H
#define RELUME_VIEWPORT_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/frame.h>
#include <relume/image.h>
#include <relume/light.h>
#include <relume/pack.h>
#include <relume/relight/slab_set.h>
#include <relume/relight/view.h>
#include <relume/renderer.h>

#ifdef __cplusplus
extern "C" {
#endif

// How a frame is seen.
enum relume_viewport_kind {
    RELUME_VIEWPORT_PERSPECTIVE = 0,  // perspective, through `window`
    RELUME_VIEWPORT_PARALLEL,         // along right x down of `window`
    RELUME_VIEWPORT_PANORAMA,         // from geometry.center, as `look` says
    RELUME_VIEWPORT_UNFOLDED,         // a whole panorama
};

// Plain data. Places are pixels of the frame, centres at +0.5, row 0 at the top.
struct relume_viewport {
    enum relume_viewport_kind kind;
    int width, height;                // of the frame
    double left, top, wide, high;     // of the picture in it, pixels; wide 0: all of the frame
    struct relume_window window;      // WINDOW, PARALLEL
    struct relume_geometry geometry;  // LOOK, UNFOLDED
    struct relume_pan_tilt look;      // LOOK
};

// Of a frame that relume_frame makes of that camera. RELUME_EINVAL, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_frame_viewport(struct relume_viewport *out, relume_pack *pack,
                                                  const struct relume_camera *camera, int width,
                                                  int height);

// The ray of a place; `direction` is a unit vector.
RELUME_API void relume_viewport_ray(struct relume_vec3 *origin, struct relume_vec3 *direction,
                                    const struct relume_viewport *viewport, double x, double y);
// Where the frame is seen from; of parallel rays, as far off as a screen is looked at.
RELUME_API struct relume_vec3 relume_viewport_eye(const struct relume_viewport *viewport);

// Add to `frame`, as relume_renderer_frame made it of the same camera, the renderer's lights in
// view. The scene hides them where the file has depth. Returns how many sources were drawn in
// `*seen` (may be NULL). RELUME_EINVAL, RELUME_EUNFIT, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_frame_visible_lights(struct relume_image *frame, int *seen,
                                                        relume_renderer *renderer,
                                                        const struct relume_camera *camera);

#ifdef __cplusplus
}
#endif
#endif
