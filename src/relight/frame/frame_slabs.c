// frame_slabs.c - a frame of several slabs around an object
#include "core/base/log.h"
#include "relight/frame/renderer.h"
#include "relight/view/slab_set.h"

#include <relume/relight/slab_set.h>

#include <math.h>

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
    if (relume_slab_set_window(window, slabs, eye, &camera->look_at, camera->width, camera->height))
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

static relume_status sees_nothing(const relume_renderer *r, vec3 eye)
{
    return log_fail(r->params.log, RELUME_EUNFIT,
                    "the eye (%g, %g, %g) sees nothing of the slabs; move it so that it "
                    "looks at the object through a camera grid",
                    eye.x, eye.y, eye.z);
}

// Pixels that hold no number become black; returns how many of them pass no slab's cameras.
static size_t blacken(struct relume_image *image, const relume_slab_set *slabs,
                      const struct relume_window *window)
{
    size_t n = 0;
    float *rgb = image->data;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++, rgb += 3) {
            if (!isnan(rgb[0]))
                continue;
            rgb[0] = rgb[1] = rgb[2] = 0.0f;
            n += !relume_slab_set_passes(slabs, window, (x + 0.5) / image->width,
                                         (y + 0.5) / image->height);
        }
    return n;
}

static relume_status draw(relume_renderer *r, const struct relume_window *window,
                          struct relume_image *out)
{
    struct relume_view_params params = r->view;
    const size_t pixels = (size_t)out->width * (size_t)out->height;
    params.nothing = NAN;
    const relume_status status =
        relume_slab_set_frame(out, r->slabs, window, r->image[r->shown], &params);
    if (status || r->shown == SHOWN_PLACES)
        return status;
    const size_t black = blacken(out, r->slabs, window);
    if (black == pixels && !r->is_part)
        return sees_nothing(r, window->eye);
    if (!r->is_part && (double)black > 0.005 * (double)pixels && !*r->note[NOTE_BESIDE])
        renderer_note(r, NOTE_BESIDE,
                      "%.0f %% of the picture is black: no camera sees what is there%s",
                      100.0 * (double)black / (double)pixels,
                      renderer_may_take_depth(r) ? "" : "; a file with depth shows more");
    return RELUME_OK;
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
        return sees_nothing(r, window.eye);
    status = renderer_need_all(r, renderer_may_take_depth(r));
    if (!status)
        status = relume_image_create(out, camera->width, camera->height, 3);
    return status ? status : draw(r, &window, out);
}
