// moving_state.h - what is kept for shadows and highlights that move, and what they are drawn of
#ifndef VIEWER_MOVING_STATE_H
#define VIEWER_MOVING_STATE_H

#include "gl/program.h"
#include "gl/target.h"
#include "relight/shadow/moving.h"
#include "relit/light_uniforms.h"

#include <relume/format/coder.h>

// Of near lights (moving_near.c).
struct moving_near {
    struct program program;
    bool ready;             // what follows is made
    GLuint triangles;       // of the captured lights ...
    int triangle_count;     // ... 0: draws cannot show near lights
    GLuint border, lights;  // of the captured zone; directions of the captured lights
    GLuint patches;         // of the area light in use
    struct light_uniforms uniforms;
};

// What all views of a file share; end with moving_destroy.
struct moving {
    const struct gl *gl;
    const struct relume_log *log;
    struct program trace, shadow, gloss;
    struct moving_near near;
    GLuint framebuffer;  // of traces
    GLuint arrives;      // texture: where the present light does
    GLuint lights;       // texture: the captured lights of highlights
};
// What the draws need to know of a view.
struct moving_view {
    relume_shadows *shadows;  // borrowed; NULL: nothing moves
    struct relume_shadows_stage stage;
    GLuint surface, span, front;  // textures of stage.glsl
    GLuint colours, matte;        // and of shadow.frag, near.frag, gloss.frag
    GLuint *reached;              // [lights]: textures of captured lights; 0: not traced yet
    int lights;
    size_t bytes;  // of graphics memory
};

// A picture of one light, relit from the codes.
struct moving_picture {
    const struct target *coded;      // the picture ...
    struct relume_transfer picture;  // ... by this curve ...
    float times[3];                  // ... times that
    const relume_coder *coder;       // of the codes
    struct relume_transfer display;  // their curve; linear: of linear codes
    struct relume_vec3 direction;    // of relume_coder_clamp
    float rgb[3];                    // of the light, its share in it
    int left, top;                   // of the picture in the view
    const struct target *whole;  // or NULL: the light is a bright source of an environment, whose
                                 // picture this is, and the source is exchanged in it
};

#endif
