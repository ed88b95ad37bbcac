// sight.c - how a frame shows the world: the ray of a pixel, the pixel of a point (viewport.h)
#include "app/sight.h"
#include "relight/frame/viewport.h"
#include "relight/view/slab_set.h"

struct relume_viewport sight_of_picture(const struct app_file *file, struct relume_vec3 eye)
{
    const struct relume_geometry *g = &file->geometry;
    struct relume_viewport s = {.width = file->width, .height = file->height, .geometry = *g};
    if (g->projection == RELUME_SLAB) {
        s.window = relume_slab_window(g, eye);
    } else if (g->projection == RELUME_PLANAR) {
        s.window = relume_planar_window(g);
        s.kind = g->perspective ? RELUME_VIEWPORT_PERSPECTIVE : RELUME_VIEWPORT_PARALLEL;
    } else {
        s.kind = RELUME_VIEWPORT_UNFOLDED;
    }
    return s;
}

bool sight_of_frame(struct relume_viewport *out, const struct frame_request *q,
                    struct relume_vec3 eye)
{
    const struct app_rectangle r = q->picture;
    *out = sight_of_picture(q->file, eye);
    if (q->file->around && !q->has_window)
        return false;
    if (q->has_window)
        out->window = q->window;
    if (q->camera.framing == RELUME_FRAME_LOOK)
        out->kind = RELUME_VIEWPORT_PANORAMA;
    out->look = q->camera.look;
    out->width = q->width;
    out->height = q->height;
    out->left = r.left;
    out->top = r.top;
    out->wide = r.right - r.left;
    out->high = r.bottom - r.top;
    return true;
}

bool sight_of_app(struct relume_viewport *out, const struct app *app)
{
    const enum relume_framing framing = app->now.camera.framing;
    struct frame_request request = {0};
    if (framing == RELUME_FRAME_VIEW && app->file.geometry.projection == RELUME_SLAB)
        return false;
    frame_request_look(&request, app);
    return sight_of_frame(out, &request, app->now.camera.eye);
}
