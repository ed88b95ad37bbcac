// frame_slab.c - a frame of a single slab: its window from an eye
#include "core/base/log.h"
#include "relight/frame/parts.h"
#include "relight/frame/renderer.h"
#include "relight/view/view.h"

// Not of a free eye, whose plane in focus is its own.
static relume_status check_focus(const relume_renderer *r)
{
    const struct relume_geometry *g = &r->info->geometry;
    const struct relume_view_params *v = &r->view;
    if (v->focus / (g->uv_z - g->st_z) < 1.0)
        return RELUME_OK;
    return log_fail(r->params.log, RELUME_EINVAL,
                    "the plane in focus lies on or behind the cameras; expected it between z = %g "
                    "and the scene; found z = %g",
                    g->uv_z, g->st_z + v->focus);
}

// A frame whose rays partly miss the cameras is no light field there any more.
static void say_beside(relume_renderer *r, vec3 eye, bool by_depth)
{
    const double beside = 1.0 - relume_slab_share(r->slab, eye);
    if (beside < 0.01 || r->shown == SHOWN_PLACES)
        return;
    renderer_note(
        r, NOTE_BESIDE,
        "%.0f %% of the picture lies beyond the cameras: shown as the nearest of them sees %s",
        100.0 * beside,
        by_depth ? "the surface there" : "it, without parallax; a file with depth moves it");
}

static relume_status draw(relume_renderer *r, const struct relume_camera *camera,
                          struct relume_image *out)
{
    const vec3 eye =
        camera->framing == RELUME_FRAME_EYE ? camera->eye : relume_slab_middle(r->slab);
    const bool by_depth = renderer_takes_depth(r);
    const int frame[2] = {camera->width, camera->height};
    // Whether parts of views do for the frame: one eye, not a lens, and light.
    bool whole = !(r->shown == SHOWN_LIGHT && renderer_goes_by_texels(r) &&
                   r->view.aperture == 0.0 && r->view.focus == 0.0);
    if (relume_slab_needs(r->needed, r->slab, eye, &r->view) == 0)
        return log_fail(r->params.log, RELUME_EUNFIT,
                        "the eye (%g, %g, %g) sees nothing of the slab; move it so that it looks "
                        "at the object through the camera grid",
                        eye.x, eye.y, eye.z);
    relume_status status = whole ? RELUME_OK : frame_parts(&whole, r, eye, frame, by_depth);
    if (!status && whole)
        status = renderer_need_all(r, by_depth);
    if (!status)
        status = relume_image_create(out, camera->width, camera->height, 3);
    const struct relume_view_params params =
        status || whole ? r->view : frame_parts_params(r, by_depth);
    if (!status)
        status = relume_slab_frame(out, r->slab, eye, whole ? r->image[r->shown] : r->parts->image,
                                   &params);
    if (!status)
        say_beside(r, eye, by_depth);
    return status;
}

relume_status frame_eye(relume_renderer *r, const struct relume_camera *camera,
                        struct relume_image *out)
{
    if (r->info->geometry.projection != RELUME_SLAB)
        return log_fail(r->params.log, RELUME_EINVAL, "an eye needs a light slab; this file is %s",
                        relume_projection_name(r->info->geometry.projection));
    relume_status status = renderer_check_depth(r);
    if (!status && (r->info->slabs || relume_look_at_given(&camera->look_at)))
        return frame_around(r, camera, out);
    if (!status)
        status = check_focus(r);
    if (!status)
        status = renderer_need_slab(r);
    return status ? status : draw(r, camera, out);
}
