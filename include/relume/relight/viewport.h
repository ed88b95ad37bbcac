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
// Pictures without perspective are looked at as a screen is: that wide, degrees across.
#define RELUME_SCREEN_DEG 45.0

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
// The rectangle of the plane z = 0 that a planar file shows, from its camera.
RELUME_API struct relume_window relume_planar_window(const struct relume_geometry *planar);

// The ray of a place; `direction` is a unit vector.
RELUME_API void relume_viewport_ray(struct relume_vec3 *origin, struct relume_vec3 *direction,
                                    const struct relume_viewport *viewport, double x, double y);
// Where the frame is seen from; of parallel rays, as far off as a screen is looked at.
RELUME_API struct relume_vec3 relume_viewport_eye(const struct relume_viewport *viewport);
// Where a point of the world appears, inside the frame or not; false behind the eye.
RELUME_API bool relume_viewport_project(double xy[2], const struct relume_viewport *viewport,
                                        struct relume_vec3 point);
// The solid angle of a pixel there.
RELUME_API double relume_viewport_solid_angle(const struct relume_viewport *viewport, double x,
                                              double y);
// Whether a surface at `surface`, in the line of sight to `point`, hides it: it is nearer by more
// than a fiftieth of the distance. Positions that are not finite hide nothing.
RELUME_API bool relume_viewport_hides(const struct relume_viewport *viewport,
                                      struct relume_vec3 surface, struct relume_vec3 point);

// ------------------------------------------------------------------ visible lights

// A light in the frame, shared out among the four pixels around its place.
struct relume_visible_light {
    double x, y;
    float rgb[3];  // the sum over its pixels
};
enum { RELUME_VISIBLE_LIGHTS_MOST = 8192 };

// The sources among `n` lights, at most RELUME_VISIBLE_LIGHTS_MOST; returns how many. A light of
// value E at the eye sends it pi E (light.h), which a pixel of solid angle w shows as pi E / w:
// near lights at their places, areas in 8 x 8 pieces, distant ones a million times as far as the
// picture is wide, but not in parallel rays; environments are left out. Of what `hides` says that
// it hides at its place in the frame, nothing is seen; NULL: nothing hides.
RELUME_API int relume_viewport_lights(
    struct relume_visible_light *out, const struct relume_viewport *viewport,
    const struct relume_light *lights, int n,
    bool (*hides)(void *user, const double xy[2], struct relume_vec3 point), void *user);
// Add `n` sources to a linear frame of three channels.
RELUME_API void relume_visible_lights_draw(struct relume_image *frame,
                                           const struct relume_visible_light *sources, int n);

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
