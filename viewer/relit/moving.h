// moving.h - shadows and highlights that move, on the GPU: a light's relit picture and what the
// model of the file adds to it (relume/shadow.h), by rays through the depth of the view or by gloss
#ifndef VIEWER_MOVING_H
#define VIEWER_MOVING_H

#include "gl/program.h"
#include "gl/target.h"

#include <relume/coder.h>
#include <relume/shadow.h>

// What all views of a file share. Zeroed but for the first two it holds nothing; the rest is made
// for the first view that needs it.
struct moving {
    const struct gl *gl;
    const struct relume_log *log;
    struct program trace, shadow, gloss;
    GLuint framebuffer;  // of traces
    GLuint arrives;      // texture: where the present light does
    GLuint lights;       // texture: the captured lights of highlights
};
void moving_destroy(struct moving *moving);

// What the passes need to know of a view.
struct moving_view {
    relume_shadows *shadows;  // borrowed; NULL: nothing moves
    struct relume_shadows_stage stage;
    GLuint surface, span, front;  // textures of stage.glsl
    GLuint colours, matte;        // and of shadow.frag, gloss.frag
    GLuint *reached;              // [lights]: textures of captured lights; 0: not traced yet
    int lights;
    size_t bytes;  // of graphics memory
};

// `shadows` must outlive it. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status moving_view_create(struct moving_view *view, struct moving *moving,
                                 relume_shadows *shadows, const relume_coder *coder);
void moving_view_destroy(struct moving_view *view, const struct gl *gl);

// A picture of one directional light, relit from the codes.
struct moving_picture {
    const struct target *coded;      // the picture ...
    struct relume_transfer picture;  // ... by this curve ...
    float times[3];                  // ... times that
    const relume_coder *coder;       // of the codes
    struct relume_transfer display;  // their curve; linear: of linear codes
    struct relume_vec3 direction;    // of relume_coder_clamp
    float rgb[3];                    // of the light, its share in it
    int left, top;                   // of the picture in the view
};
// Draw what the view shows of that light into `into`, added to what it holds. RELUME_ENOMEM,
// RELUME_ESYSTEM.
relume_status moving_draw(struct moving *moving, struct moving_view *view,
                          const struct moving_picture *picture, const struct target *into);

#endif
