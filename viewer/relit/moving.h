// moving.h - shadows and highlights that move, on the GPU: a light's relit picture and what the
// model of the file adds to it (relume/relight/shadow.h), by rays through the depth of the view or
// by gloss
#ifndef VIEWER_MOVING_H
#define VIEWER_MOVING_H

#include "relight/shadow/moving.h"
#include "relit/moving_state.h"

// The rest is made for the first view that needs it.
void moving_create(struct moving *moving, const struct gl *gl, const struct relume_log *log);
void moving_destroy(struct moving *moving);
// Pictures and photometric files may have gone: forget what was kept of them.
void moving_forget(struct moving *moving);

// `shadows` must outlive it. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status moving_view_create(struct moving_view *view, struct moving *moving,
                                 relume_shadows *shadows, const relume_coder *coder);
void moving_view_destroy(struct moving_view *view, const struct gl *gl);

// Draw what the view shows of a directional light into `into`, added to what it holds.
// RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status moving_draw(struct moving *moving, struct moving_view *view,
                          const struct moving_picture *picture, const struct target *into);

// Whether draws can show near lights of views with traced shadows: not without triangles between
// the captured lights, nor with too many for a texture. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status moving_near_can(bool *can, struct moving *moving, const struct moving_view *view,
                              const relume_coder *coder);
// The same as moving_draw for a near light whose picture is linear, where draws can show it.
// `positions`: nearby_view.
relume_status moving_draw_near(struct moving *moving, const struct moving_view *view,
                               const struct moving_picture *picture,
                               const struct relume_light *light, GLuint positions,
                               const struct target *into);

#endif
