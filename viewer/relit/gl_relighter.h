// gl_relighter.h - views of a file on the GPU: codes are uploaded once, relit when the lights
// change
//
// Linear-domain codes fold all distant lights into one weight vector and one draw; display-domain
// codes take two small draws for each light: the dot product, then decoding and adding in linear
// light. Environments use a linear copy of display-domain codes, made once (relume_refit). Near
// lights are a draw each (nearby.h). What moves (moving.h) takes each light alone, and each bright
// source of an environment. Where OpenGL is software the library does all of it, several times
// faster (relume_relighter).
#ifndef VIEWER_GL_RELIGHTER_H
#define VIEWER_GL_RELIGHTER_H

#include "relit/gl_relighter_state.h"

// `gl`, `log` and the source must outlive it. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status gl_relighter_create(struct gl_relighter *relighter, const struct gl *gl,
                                  const struct code_source *source, int views,
                                  const struct relume_log *log);
void gl_relighter_destroy(struct gl_relighter *relighter);

// A new frame begins under these lights; equal lights keep what is relit. RELUME_ENOMEM.
relume_status gl_relighter_begin(struct gl_relighter *relighter, const struct relume_light *lights,
                                 int n);
// What lights point at may have gone: nothing that was kept for them is used again.
void gl_relighter_forget(struct gl_relighter *relighter);
// The linear texture of `view`, valid during this frame. Views that this frame has not asked for
// may leave the graphics memory for others.
relume_status gl_relighter_view(const struct target **out, struct gl_relighter *relighter,
                                int view);

// From now on views are read in the background: gl_relighter_view gives NULL for one that is still
// being read. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status gl_relighter_stream(struct gl_relighter *relighter);
// As gl_relighter_view, waiting for the view.
relume_status gl_relighter_wait(const struct target **out, struct gl_relighter *relighter,
                                int view);
// Whether all of a view is on the GPU.
bool gl_relighter_has(const struct gl_relighter *relighter, int view);

// As gl_relighter_view, of the rectangle `*at` of a view of size[0] x size[1] alone, of `parts`,
// read at once: `*at` becomes what the texture holds, which is more. Not for near
// lights, nor for environments on codes of the display domain.
relume_status gl_relighter_part(const struct target **out, struct relume_rect *at,
                                struct gl_relighter *relighter, int view, const int size[2]);
// Graphics memory of a view with such codes, relit.
size_t gl_relighter_view_bytes(const struct relume_codes *codes);

#endif
