// gl_convolver.h - a frame convolved with an eye's pattern by compute shaders
#ifndef VIEWER_GL_CONVOLVER_H
#define VIEWER_GL_CONVOLVER_H

#include "gl/target.h"
#include "glare/gl_psf.h"
#include "relight/eye/veil.h"

#include <relume/relight/glare.h>

// For frames of one size and patterns of one size in pixels.
struct gl_convolver {
    int width, height;  // of the frame
    int reach;          // of the pattern, pixels to either side
    int most[2];        // pixels of pattern and veil that matter, to the sides and up or down
    int size[2];        // of a plane
    struct program frame, rows, columns, sum, kernel, product, picture;
    GLuint spectrum, work;        // two planes of complex numbers each
    GLuint row, pixels, sums;     // [2 reach + 1][field], [2 reach + 1]^2, [2 reach + 1] of rgb
    GLuint total, veil;           // rgb; [RELUME_VEIL_STEPS + 2]
    double veil_pixel, veil_sum;  // of the veil in pixels of that size, per steradian of one
    bool kept;                    // `spectrum` is of a frame
};

// How it looks: what a convolver must fit.
struct gl_convolver_view {
    double pixel;  // radians, over the magnification
    bool veiled;
    struct relume_veil veil;
};
// Whether `c` is for such a frame and view.
bool gl_convolver_fits(const struct gl_convolver *c, const struct relume_psf_geometry *shape,
                       const struct gl_convolver_view *view, int width, int height);
// `*fits`: false when the card has no memory for it; nothing is made then. RELUME_ESYSTEM.
relume_status gl_convolver_create(struct gl_convolver *c, const struct gl *gl,
                                  const struct relume_psf_geometry *shape,
                                  const struct gl_convolver_view *view, int width, int height,
                                  bool *fits, const struct relume_log *log);
void gl_convolver_destroy(struct gl_convolver *c, const struct gl *gl);
// `seen` = `frame` * pattern, times the light that the lids let through. `same` promises that the
// frame is as it was. Infinite numbers count as `greatest`. RELUME_ESYSTEM.
relume_status gl_convolver_run(struct gl_convolver *c, const struct gl *gl, struct gl_fft *fft,
                               const struct target *seen, const struct target *frame, bool same,
                               double greatest, const struct gl_psf *psf,
                               const struct gl_convolver_view *view, const struct relume_log *log);

#endif
