// frame_slabs.c - a frame of several slabs around an object
#include "base/log.h"
#include "frame/renderer.h"

#include <relume/slabs.h>

// What tells the slab of a view.
struct members {
    const relume_slabs *slabs;
    const int *slab_of;  // [views], or NULL
};

static const relume_slab *member(const void *members, int view)
{
    const struct members *m = members;
    return relume_slabs_slab(m->slabs, m->slab_of ? m->slab_of[view] : 0);
}

relume_status renderer_slabs(relume_slabs **slabs, const struct renderer *r)
{
    const struct relume_pack_info *info = r->info;
    const relume_status status =
        relume_slabs_create(slabs, info->slabs ? info->slab : &info->geometry,
                            info->slabs ? info->slabs : 1, info->uv, info->slab_of, info->views);
    return status ? log_fail(r->params.log, status == RELUME_EINVAL ? RELUME_EDATA : status,
                             "the cameras of a slab do not form a grid")
                  : RELUME_OK;
}

static relume_status gather(struct gathered *g, const struct renderer *r, const relume_slabs *slabs,
                            const struct relume_window *window, int width)
{
    const struct members members = {slabs, r->info->slab_of};
    const vec3 eye = window->eye;
    relume_status status = gathered_create(g, r);
    if (!status && relume_slabs_needs(g->needed, slabs, window, width, &r->view) == 0)
        status = log_fail(r->params.log, RELUME_EDATA,
                          "the eye (%g, %g, %g) sees nothing of the slabs; move it so that it "
                          "looks at the object through a camera grid",
                          eye.x, eye.y, eye.z);
    return status ? status : gathered_fill(g, r, renderer_may_take_depth(r), member, &members);
}

static relume_status choose_window(struct relume_window *window, const struct renderer *r,
                                   const relume_slabs *slabs, const struct relume_camera *camera,
                                   int width, int height)
{
    const vec3 eye = camera->framing == RELUME_FRAME_EYE ? camera->eye : relume_slabs_eye(slabs, 0);
    if (camera->through > 0 && camera->through <= relume_slabs_count(slabs)) {
        *window = relume_slab_window(relume_slabs_geometry(slabs, camera->through - 1), eye);
        return RELUME_OK;
    }
    if (relume_slabs_window(window, slabs, eye, &camera->aim, width, height))
        return RELUME_OK;
    return log_fail(
        r->params.log, RELUME_EINVAL,
        "the eye (%g, %g, %g) cannot look there; expected a look-at point away from it, an up that "
        "does not point along the view, and a field of view below 180 degrees",
        eye.x, eye.y, eye.z);
}

static relume_status check_lens(const struct renderer *r, const struct relume_window *window)
{
    const struct relume_view_params *v = &r->view;
    const double away = relume_window_distance(window);
    if (relume_lens_fits(window, v->aperture, v->focus))
        return RELUME_OK;
    return log_fail(r->params.log, RELUME_EINVAL,
                    "the plane in focus lies on or behind the eye; expected less than %g in front "
                    "of the look-at point; found %g",
                    away, v->focus);
}

relume_status frame_around(const struct renderer *r, const struct relume_camera *camera,
                           struct relume_image *out)
{
    const int width = camera->width, height = camera->height;
    struct relume_view_params params = r->view;
    struct relume_window window;
    struct gathered g = {0};
    relume_slabs *slabs;
    relume_status status = renderer_slabs(&slabs, r);
    if (!status)
        status = choose_window(&window, r, slabs, camera, width, height);
    if (!status)
        status = check_lens(r, &window);
    if (!status)
        status = gather(&g, r, slabs, &window, width);
    if (!status)
        status = relume_image_create(out, width, height, 3);
    params.disparity = g.disparity;
    if (!status)
        status = relume_slabs_frame(out, slabs, &window, g.images, &params);
    gathered_destroy(&g);
    relume_slabs_destroy(&slabs);
    return status;
}
