// visible_lights.h - the lights that are in view of a frame (viewport.h)
//
// The surface hides what lies behind it, as the nearest view knows it.
#ifndef VIEWER_VISIBLE_LIGHTS_H
#define VIEWER_VISIBLE_LIGHTS_H

#include "app/frame_request.h"
#include "relight/frame/viewport.h"
#include "relit/loader.h"

#include <relume/relight/viewport.h>

// Where views stand, and where their pixels lie. `source` and `uv` must outlive it.
struct hiding_scene {
    struct code_source source;
    const double (*uv)[2];  // [views], of a slab
    int views;
    int view;  // that `surface` is of
    bool known;
    struct relume_image surface;  // no data: nothing is known of the view
};
void hiding_scene_forget(struct hiding_scene *scene);

// As relume_viewport_lights. Without `scene` nothing is hidden.
int visible_lights(struct relume_visible_light *out, const struct frame_request *request,
                   const struct relume_light *lights, int n, struct hiding_scene *scene);

// The places that the pixels of a view show; NULL where they are not known.
const struct relume_image *visible_places(struct hiding_scene *scene, int view);

// The surface that the frame shows at (x, y), as the nearest view knows it; false where nothing is
// known.
bool visible_surface(struct relume_vec3 *out, const struct frame_request *request,
                     struct hiding_scene *scene, double x, double y);

#endif
