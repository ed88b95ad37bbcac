// request.h - a frame of an app, drawn
#ifndef TESTS_REQUEST_H
#define TESTS_REQUEST_H

#include "app/frame_request.h"
#include "draw/gl_renderer.h"

static inline relume_status draw_app(struct gl_renderer *r, const struct app *app)
{
    struct frame_request q = {0};
    relume_status status = frame_request_make(&q, app);
    if (!status)
        status = gl_renderer_draw(r, &q);
    frame_request_free(&q);
    return status;
}

#endif
