// frame_slabs.c - a frame of several slabs around an object
#include "base/log.h"
#include "frame/renderer.h"

#include <relume/slab_set.h>

static relume_status choose_window(struct relume_window *window, const relume_renderer *r,
                                   const struct relume_camera *camera)
{
    const relume_slab_set *slabs = r->slabs;
    const vec3 eye =
        camera->framing == RELUME_FRAME_EYE ? camera->eye : relume_slab_set_eye(slabs, 0);
    if (camera->through > 0 && camera->through <= relume_slab_set_count(slabs)) {
        *window = relume_slab_window(relume_slab_set_geometry(slabs, camera->through - 1), eye);
        return RELUME_OK;
    }
    if (relume_slab_set_window(window, slabs, eye, &camera->aim, camera->width, camera->height))
        return RELUME_OK;
    return log_fail(
        r->params.log, RELUME_EINVAL,
        "the eye (%g, %g, %g) cannot look there; expected a look-at point away from it, an up that "
        "does not point along the view, and a field of view below 180 degrees",
        eye.x, eye.y, eye.z);
}

static relume_status check_lens(const relume_renderer *r, const struct relume_window *window)
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

relume_status frame_around(relume_renderer *r, const struct relume_camera *camera,
                           struct relume_image *out)
{
    struct relume_window window;
    relume_status status = renderer_need_slabs(r);
    if (!status)
        status = choose_window(&window, r, camera);
    if (!status)
        status = check_lens(r, &window);
    if (status)
        return status;
    if (relume_slab_set_needs(r->needed, r->slabs, &window, camera->width, &r->view) == 0)
        return log_fail(r->params.log, RELUME_EUNFIT,
                        "the eye (%g, %g, %g) sees nothing of the slabs; move it so that it "
                        "looks at the object through a camera grid",
                        window.eye.x, window.eye.y, window.eye.z);
    status = renderer_need_all(r, renderer_may_take_depth(r));
    if (!status)
        status = relume_image_create(out, camera->width, camera->height, 3);
    return status ? status
                  : relume_slab_set_frame(out, r->slabs, &window, r->image[r->shown], &r->view);
}
