// relighter.h - views of a file on the GPU: codes are uploaded once, relit when the lights change
//
// Linear-domain codes fold all distant lights into one weight vector and one pass; display-domain
// codes take two small passes for each light: the dot product, then decoding and adding in linear
// light. Environments meet a linear twin of display-domain codes, made once (relume_refit). Near
// lights are a pass each (nearby.h). Where OpenGL is software the library does all of it, several
// times faster (relume_relighter).
#ifndef VIEWER_RELIGHTER_H
#define VIEWER_RELIGHTER_H

#include "gl/program.h"
#include "gl/target.h"
#include "relit/loader.h"
#include "relit/nearby.h"

#include <relume/relight.h>
#include <relume/relighter.h>

struct relit_view {
    bool present;
    GLuint *array;  // [arrays]: array textures of codes, four planes a texel, or one of indices,
                    // a layer for each codebook
    int arrays;
    int layers;          // of all arrays together
    size_t bytes, kept;  // of all it has, and of that by `library`
    uint64_t used;       // the frame that last asked for it
    bool fresh;          // `relit` shows the present lights
    struct target relit;
    struct relume_codes codes;  // planes and indices are gone; the rest is ours
    float *scale;
    struct nearby_view near;
    const struct relume_codes *lent;  // by the source, where the library relights it; else NULL
    struct relume_image surface;      // then; empty: not known yet
};

// The codes of the linear twin come from those of the file.
struct linear_source {
    struct code_source source;
    relume_refit *first;  // the first view's: all others have its coder
    relume_refit *refit;  // of the view that was asked for last, or NULL: the first
    const struct relume_log *log;
};

struct relighter {
    const struct gl *gl;
    const struct relume_log *log;
    struct code_source source;
    struct loader *loader;  // or NULL: views are read when they are asked for
    bool pending;           // this frame asked for a view that is still being read
    struct program dot, develop, lookup;
    struct nearby near;
    bool by_library;  // not by passes: where OpenGL is software. May be set before the first
                      // view is asked for
    relume_relighter *library;  // NULL: not needed yet
    int threads;                // of it; 0: all cores
    relume_weight_grid *grid;   // of the coder, for environments; NULL: not made yet
    struct relighter *linear;   // the linear twin, under the environments; NULL: not made yet
    struct linear_source linear_source;
    GLuint vertices;
    GLuint weights;       // texture [layers][3]
    GLuint table;         // array texture [books] of relit code vectors
    struct target coded;  // display domain: sum of one light, still coded
    struct relit_view *view;
    int views;
    struct relume_light *light;
    int lights;
    size_t budget, bytes;  // of graphics memory for codes and relit views; the budget, a gigabyte
                           // to begin with, may be set at any time
    uint64_t frame;
};

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
bool relighter_has(const struct relighter *relighter, int view);

#endif
