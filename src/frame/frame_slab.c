// frame_slab.c - a frame of a single slab: its window from an eye
#include "base/log.h"
#include "frame/renderer.h"

// Not of a free eye, whose plane in focus is its own.
static relume_status check_focus(const struct renderer *r)
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

relume_status renderer_check_depth(const struct renderer *r)
{
    if (r->view.interpolation == RELUME_INTERPOLATE_DEPTH && !r->info->has_depth)
        return log_fail(r->params.log, RELUME_EDATA,
                        "interpolation by depth needs a file with depth; use --interpolate linear");
    return RELUME_OK;
}

static const relume_slab *only_slab(const void *slab, int view)
{
    (void)view;
    return slab;
}

relume_status renderer_slab(relume_slab **slab, const struct renderer *r)
{
    const relume_status status =
        relume_slab_create(slab, &r->info->geometry, r->info->uv, r->info->views);
    return status ? log_fail(r->params.log, status == RELUME_EINVAL ? RELUME_EDATA : status,
                             "the cameras of the slab do not form a grid")
                  : RELUME_OK;
}

// A frame whose rays partly miss the cameras is no light field there any more.
static void say_beside(const struct renderer *r, const relume_slab *slab, vec3 eye, bool by_depth)
{
    const double beside = 1.0 - relume_slab_share(slab, eye);
    if (beside < 0.01 || r->params.places)
        return;
    log_line(r->params.log, RELUME_NOTE,
             "%.0f %% of the picture lies beyond the cameras: shown as the nearest of them sees %s",
             100.0 * beside,
             by_depth ? "the surface there" : "it, without parallax; a file with depth moves it");
}

static relume_status draw(const struct renderer *r, const struct relume_camera *camera,
                          const relume_slab *slab, struct gathered *g, struct relume_image *out)
{
    const vec3 eye = camera->framing == RELUME_FRAME_EYE ? camera->eye : relume_slab_middle(slab);
    struct relume_view_params params = r->view;
    if (relume_slab_needs(g->needed, slab, eye, &r->view) == 0)
        return log_fail(r->params.log, RELUME_EDATA,
                        "the eye (%g, %g, %g) sees nothing of the slab; move it so that it looks "
                        "at the object through the camera grid",
                        eye.x, eye.y, eye.z);
    relume_status status = gathered_fill(g, r, renderer_takes_depth(r), only_slab, slab);
    params.disparity = g->disparity;
    if (!status)
        status = relume_image_create(out, camera->width, camera->height, 3);
    if (!status)
        status = relume_slab_frame(out, slab, eye, g->images, &params);
    if (!status)
        say_beside(r, slab, eye, g->disparity != NULL);
    return status;
}

relume_status frame_eye(const struct renderer *r, const struct relume_camera *camera,
                        struct relume_image *out)
{
    if (r->info->geometry.projection != RELUME_SLAB)
        return log_fail(r->params.log, RELUME_EINVAL, "an eye needs a light slab; this file is %s",
                        relume_projection_name(r->info->geometry.projection));
    relume_slab *slab = NULL;
    struct gathered gathered = {0};
    relume_status status = renderer_check_depth(r);
    if (!status && (r->info->slabs || relume_aim_given(&camera->aim)))
        return frame_around(r, camera, out);
    if (!status)
        status = check_focus(r);
    if (!status)
        status = renderer_slab(&slab, r);
    if (!status)
        status = gathered_create(&gathered, r);
    if (!status)
        status = draw(r, camera, slab, &gathered, out);
    gathered_destroy(&gathered);
    relume_slab_destroy(&slab);
    return status;
}
