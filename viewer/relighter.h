// relighter.h - views of a file on the GPU: codes are uploaded once, relit when the lights change
//
// Linear-domain codes fold all lights into one weight vector and one pass; display-domain codes
// take two small passes for each light: the dot product, then decoding and adding in linear light.
#ifndef VIEWER_RELIGHTER_H
#define VIEWER_RELIGHTER_H

#include "program.h"
#include "target.h"

#include <relume/relight.h>

// Where codes come from: a pack, or a test. `drop` (may be NULL) hears that a view has been
// uploaded.
struct code_source {
    relume_status (*codes)(const struct relume_codes **out, void *user, int view);
    void (*drop)(void *user, int view);
    void *user;
};

struct relit_view {
    GLuint *array;  // [arrays]: array textures of codes, four planes a texel, or one of indices,
                    // a layer for each codebook; NULL: not uploaded
    int arrays;
    int layers;  // of all arrays together
    size_t bytes;
    uint64_t used;  // the frame that last asked for it
    bool fresh;     // `relit` shows the present lights
    struct target relit;
    struct relume_codes codes;  // planes and indices are gone; the rest is ours
    float *scale;
};

struct relighter {
    const struct gl *gl;
    const struct relume_log *log;
    struct code_source source;
    struct program dot, develop, lookup;
    GLuint vertices;
    GLuint weights;       // texture [layers][3]
    GLuint table;         // array texture [books] of relit code vectors
    struct target coded;  // display domain: sum of one light, still coded
    struct relit_view *view;
    int views;
    struct relume_light *light;
    int lights;
    size_t budget, bytes;  // of graphics memory for codes and relit views
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
// The linear texture of `view`, valid during this frame. Views that this frame has not asked for
// may leave the graphics memory to make room.
relume_status relighter_view(const struct target **out, struct relighter *relighter, int view);

#endif
