// gl_relighter.h - views of a file on the GPU: codes are uploaded once, relit when the lights
// change
//
// Linear-domain codes fold all distant lights into one weight vector and one pass; display-domain
// codes take two small passes for each light: the dot product, then decoding and adding in linear
// light. Environments use a linear copy of display-domain codes, made once (relume_refit). Near
// lights are a pass each (nearby.h). What moves (moving.h) takes each light alone, and each sun of
// an environment. Where OpenGL is software the library does all of it, several times faster
// (relume_relighter).
#ifndef VIEWER_GL_RELIGHTER_H
#define VIEWER_GL_RELIGHTER_H

#include "relit/gl_relighter_state.h"

// `gl`, `log` and the source must outlive it. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status relighter_create(struct relighter *relighter, const struct gl *gl,
                               const struct code_source *source, int views,
                               const struct relume_log *log);
void relighter_destroy(struct relighter *relighter);

// A new frame begins under these lights; equal lights keep what is relit. RELUME_ENOMEM.
relume_status relighter_begin(struct relighter *relighter, const struct relume_light *lights,
                              int n);
// What lights point at may have gone: nothing that was kept for them is used again.
void relighter_forget(struct relighter *relighter);
// The linear texture of `view`, valid during this frame. Views that this frame has not asked for
// may leave the graphics memory to make room.
relume_status relighter_view(const struct target **out, struct relighter *relighter, int view);

// From now on views are read in the background: relighter_view gives NULL for one that is still
// being read. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status relighter_stream(struct relighter *relighter);
// As relighter_view, waiting for the view.
relume_status relighter_wait(const struct target **out, struct relighter *relighter, int view);
// Whether all of a view is on the GPU.
bool relighter_has(const struct relighter *relighter, int view);

// As relighter_view, of the rectangle `*at` of a view of size[0] x size[1] alone, of `parts`,
// read at once: `*at` becomes what the texture holds, which is more. Not for near
// lights, nor for environments on codes of the display domain.
relume_status relighter_part(const struct target **out, struct relume_rect *at,
                             struct relighter *relighter, int view, const int size[2]);
// Graphics memory of a view with such codes, relit.
size_t relighter_view_bytes(const struct relume_codes *codes);

#endif
