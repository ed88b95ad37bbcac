// gl_glare.h - a frame as an eye sees it, by compute shaders of OpenGL 4.3
#ifndef VIEWER_GL_GLARE_H
#define VIEWER_GL_GLARE_H

#include "glare/gl_convolver.h"

// All zero to begin with.
struct gl_glare {
    struct gl_fft fft;
    struct gl_psf psf;
    struct gl_convolver convolver;
    struct program watch;
    struct target before;  // the frame that was watched last
    GLuint results;
    int capacity;  // of `results`, work groups
};
void gl_glare_destroy(struct gl_glare *g, const struct gl *gl);

// What must be known of a frame before it is seen.
struct gl_glare_facts {
    double luminance;  // mean, never negative
    double greatest;   // finite number
    bool same;         // as the last one
};
// RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status gl_glare_watch(struct gl_glare_facts *out, struct gl_glare *g, const struct gl *gl,
                             const struct target *frame, const struct relume_log *log);

// The pattern of `params`, made anew. As gl_psf_create.
relume_status gl_glare_prepare(struct gl_glare *g, const struct gl *gl,
                               const struct relume_psf_params *params);
// As gl_psf_update.
relume_status gl_glare_update(struct gl_glare *g, const struct gl *gl, const relume_eye *eye,
                              const struct relume_log *log);
// `frame` as it was watched, into `seen`. `*fits` is false when the card has no memory; nothing was
// done then. RELUME_ESYSTEM.
relume_status gl_glare_apply(struct gl_glare *g, const struct gl *gl, const struct target *seen,
                             const struct target *frame, const struct gl_glare_facts *facts,
                             const relume_eye *eye, const struct relume_glare_params *view,
                             bool *fits, const struct relume_log *log);

#endif
