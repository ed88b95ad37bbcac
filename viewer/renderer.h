// renderer.h - what the app says becomes a frame: relit views, then the drawing of the framing
#ifndef VIEWER_RENDERER_H
#define VIEWER_RENDERER_H

#include "app.h"
#include "draw.h"
#include "relighter.h"

struct renderer {
    const struct gl *gl;
    const struct relume_log *log;
    struct relighter relighter;
    struct program picture, slab, panorama, ball, present;
    GLuint vertices;
    struct target frame;
    relume_slab *grid;  // NULL: not a slab
    struct relume_geometry geometry;
    int views;
    double (*uv)[2];              // [views]
    bool *needed;                 // [views]
    const struct target **relit;  // [views]; NULL where not needed
};

// `uv` [views] places the cameras of a slab. RELUME_ESYSTEM, RELUME_ENOMEM, RELUME_EDATA.
relume_status renderer_create(struct renderer *renderer, const struct gl *gl,
                              const struct code_source *source,
                              const struct relume_geometry *geometry, const double (*uv)[2],
                              int views, const struct relume_log *log);
void renderer_destroy(struct renderer *renderer);

// Draw the frame that `app` describes, linear, into renderer->frame. After renderer_stream, views
// that are still being read are stood in for by their nearest neighbours, and renderer_is_pending
// tells that another frame would be better.
relume_status renderer_stream(struct renderer *renderer);
bool renderer_is_pending(const struct renderer *renderer);
relume_status renderer_draw(struct renderer *renderer, const struct app *app);
// The last frame as an image, linear; the caller destroys it.
relume_status renderer_read(struct relume_image *out, const struct renderer *renderer);
// The last frame onto the screen.
void renderer_present(const struct renderer *renderer);

#endif
