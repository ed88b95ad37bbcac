// gl_relighter_state.h - what a relighter keeps of the views of a file
#ifndef VIEWER_GL_RELIGHTER_STATE_H
#define VIEWER_GL_RELIGHTER_STATE_H

#include "core/base/budget.h"
#include "format/coder/coding.h"
#include "gl/program.h"
#include "gl/target.h"
#include "relight/frame/relighter.h"
#include "relight/shadow/moving.h"
#include "relit/loader.h"
#include "relit/moving_state.h"
#include "relit/nearby.h"

#include <relume/relight/relight.h>

struct relit_view {
    bool present;
    GLuint *array;  // [arrays]: array textures of codes, four planes a texel, or one of indices,
                    // a layer for each codebook
    int arrays;
    int layers;                     // of all arrays together
    size_t kept;                    // bytes of `library` for it
    bool fresh;                     // `relit` shows the present lights
    struct relume_rect at;          // what is here of the view; width 0: all of it
    struct relume_codes_part part;  // then, where the library relights it
    struct target relit;
    struct relume_codes codes;  // planes and indices are gone; the rest is ours
    float *scale;
    struct nearby_view near;
    struct moving_view moving;        // of `shadows`, where draws relight it
    const struct relume_codes *lent;  // by the source, where the library relights it; else NULL
    struct relume_image surface;      // then; empty: not known yet
    relume_shadows *shadows;          // NULL: not asked for yet, or none
};

// The codes of the linear copy come from those of the file.
struct linear_source {
    struct code_source source;
    relume_refit *first;  // the first view's: all others have its coder
    relume_refit *refit;  // of the view that was asked for last, or NULL: the first
    const struct relume_log *log;
};

struct gl_relighter {
    const struct gl *gl;
    const struct relume_log *log;
    struct code_source source;
    struct part_source parts;  // may be set before the first view is asked for
    struct loader *loader;     // or NULL: views are read when they are asked for
    bool pending;              // this frame asked for a view that is still being read
    struct program dot, develop, lookup;
    struct nearby near;
    struct moving moving;
    bool by_library;  // not on the GPU: where OpenGL is software. May be set before the first
                      // view is asked for
    relume_relighter *library;    // NULL: not needed yet
    int threads;                  // of it; 0: all cores
    relume_weight_grid *grid;     // of the coder, for environments; NULL: not made yet
    struct gl_relighter *linear;  // the linear copy, under the environments; NULL: not made yet
    struct linear_source linear_source;
    GLuint vertices;
    GLuint weights;              // texture [layers][3]
    GLuint table;                // array texture [books] of relit code vectors
    struct target exchanged[2];  // pictures of an environment before and after the exchange of a
                                 // bright source
    struct target coded;         // display domain: sum of one light, still coded
    struct relit_view *view;
    int views;
    struct relume_light *light;
    int lights;
    struct budget memory;  // of graphics memory for codes and relit views, a round for each frame;
                           // `most`, a gigabyte to begin with, may be set at any time
};

#endif
