// load.c - one image of a capture in memory, as distant lights would show it
#include "capture/manifest/near_view.h"
#include "core/base/log.h"

// Fall-off of near lights is divided out.
static relume_status level(struct relume_image *image, const relume_capture *capture, int view,
                           int light, const struct relume_log *log)
{
    struct near_view near;
    if (!near_view_applies(capture, view))
        return RELUME_OK;
    const relume_status status = near_view_open(&near, capture, view, log);
    if (!status)
        near_view_level(&near, light, image);
    near_view_close(&near);
    return status;
}

relume_status relume_capture_image(struct relume_image *out, const relume_capture *capture,
                                   int view, int light, const struct relume_log *log)
{
    const struct relume_transfer linear = {.curve = RELUME_CURVE_LINEAR};
    *out = (struct relume_image){0};
    struct image_stream stream;
    relume_status status = capture_stream(&stream, capture, view, light, linear, log);
    if (status)
        return status;
    stream.finite_only = true;
    status = relume_image_create(out, capture->width, capture->height, 3);
    if (!status)
        status = image_stream_read(&stream, 0, capture->height, out->data);
    if (relume_status_is_input(status))
        (void)log_fail(log, status, "%s: %s", capture->draft.m.view[view].images[light],
                       image_stream_error(&stream));
    if (!status)
        status = level(out, capture, view, light, log);
    if (status)
        relume_image_destroy(out);
    image_stream_close(&stream);
    return status;
}
