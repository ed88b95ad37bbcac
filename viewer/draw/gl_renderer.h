// gl_renderer.h - what the app says becomes a frame: relit views, then the drawing of the framing
#ifndef VIEWER_GL_RENDERER_H
#define VIEWER_GL_RENDERER_H

#include "draw/gl_renderer_state.h"

#include <relume/relight/tone.h>

// `uv` [views] places the cameras of a slab; NULL: there is none, or gl_renderer_use_slabs places
// them. RELUME_ESYSTEM, RELUME_ENOMEM, RELUME_EUNFIT.
relume_status gl_renderer_create(struct gl_renderer *renderer, const struct gl *gl,
                                 const struct code_source *source,
                                 const struct relume_geometry *geometry, const double (*uv)[2],
                                 int views, const struct relume_log *log);
void gl_renderer_destroy(struct gl_renderer *renderer);

// Several slabs; all of it must outlive the renderer.
void gl_renderer_use_slabs(struct gl_renderer *renderer, const relume_slab_set *slabs,
                           const double (*uv)[2], const int *slab_of);

// The views of a slab, or of several, have depth, which takes a quarter of the budget of codes and
// relit views. RELUME_ENOMEM.
relume_status gl_renderer_use_depth(struct gl_renderer *renderer,
                                    const struct depth_source *source);

// Where the views that an eye of a slab needs would not fit into the graphics memory, parts of them
// are read from `parts`.
void gl_renderer_use_parts(struct gl_renderer *renderer, const struct part_source *parts,
                           const struct relume_pack_info *info);

// A large view's own pixels come as tiles. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status gl_renderer_use_tiles(struct gl_renderer *renderer, const struct code_source *source,
                                    const struct tile_map *map);

// A painter in place of codes, of a planar file; once more when it would paint otherwise.
void gl_renderer_use_painter(struct gl_renderer *renderer, const struct view_painter *painter);

// A capture of the file to compare with, for RELUME_PASS_DIFFERENCE; it must outlive the renderer.
void gl_renderer_use_capture(struct gl_renderer *renderer, const relume_capture *capture);

// Objects covered with measured materials, which must outlive the renderer: into the scene whose
// views' places `places` gives (three channels), or alone on a stage when that is NULL.
// RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status gl_renderer_use_objects(struct gl_renderer *renderer, relume_objects *objects,
                                      const struct depth_source *places);
// Others on the same stage, before the old ones are destroyed.
relume_status gl_renderer_replace_objects(struct gl_renderer *r, relume_objects *objects);

// Light may go between the scene and the objects, as `exchange` has them, which is copied; of a
// scene file all that is seen is drawn so, on the stage of gl_renderer_use_slabs.
void gl_renderer_use_exchange(struct gl_renderer *renderer, const struct exchange_source *exchange);
// Nobody looks at the objects from another thread until the next frame.
void gl_renderer_let_go(struct gl_renderer *renderer);
// Whether a picture that is made in another thread will change what the last frame shows, and
// whether there is one.
bool gl_renderer_expects(const struct gl_renderer *renderer);
bool gl_renderer_has_news(const struct gl_renderer *renderer);
// Until none is expected. RELUME_ECANCEL when the log's progress asks for it.
relume_status gl_renderer_wait(struct gl_renderer *renderer);

// Draw that frame, linear, into renderer->frame. After gl_renderer_stream, views
// that are still being read are stood in for by their nearest neighbours, and
// gl_renderer_is_pending is then true: another frame would be better.
relume_status gl_renderer_stream(struct gl_renderer *renderer);
bool gl_renderer_is_pending(const struct gl_renderer *renderer);
relume_status gl_renderer_draw(struct gl_renderer *renderer, const struct frame_request *request);
// The last frame as an image, linear; the caller destroys it.
relume_status gl_renderer_read(struct relume_image *out, const struct gl_renderer *renderer);
// Meters a small copy of the last frame, as relume_tone_meter_for does.
relume_status gl_renderer_meter(double *ev, struct gl_renderer *renderer,
                                const struct relume_tone *tone);
// The last frame by relume_tones[tone] onto a framebuffer of its size, coded for the screen (0: the
// screen).
void gl_renderer_present(const struct gl_renderer *renderer, const struct window_place *window,
                         int tone, double white, GLuint framebuffer);

#endif
