// gl_psf.h - the pattern of one point source by compute shaders: what relume_psf_update does
#ifndef VIEWER_GL_PSF_H
#define VIEWER_GL_PSF_H

#include "glare/gl_aperture.h"
#include "glare/gl_fft.h"
#include "relight/eye/pattern.h"

#include <relume/relight/psf.h>

struct gl_psf {
    struct relume_psf_geometry shape;
    struct relume_psf_spectrum spectrum;
    int tiles;  // of the transform's size along a side of the aperture, odd
    struct gl_aperture aperture;
    struct program wave, power, smear, colour;
    GLuint waves, phase, texel;  // buffers: complex [size]^2, complex [tiles size], [size]
    GLuint mono, smeared;        // [size + 1]^2
    GLuint taps, colours;        // [taps] of (scale, rgb); [field]^2 of rgb, not normalised
    double dioptres;             // that `phase` is of
    double light;                // share that the lids let through
};

// Whether the card can: it has transforms of that size, all is in one plane, buffers are large
// enough.
bool gl_psf_fits(const struct gl *gl, const struct relume_psf_params *params);
// RELUME_ESYSTEM, RELUME_ENOMEM, RELUME_EINVAL.
relume_status gl_psf_create(struct gl_psf *psf, const struct gl *gl,
                            const struct relume_psf_params *params);
void gl_psf_destroy(struct gl_psf *psf, const struct gl *gl);
// Lids that are shut leave the pattern as it was, with light 0. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status gl_psf_update(struct gl_psf *psf, const struct gl *gl, struct gl_fft *fft,
                            const relume_eye *eye, const struct relume_log *log);

// Work groups of 16 x 16 over that much, then what they wrote can be read.
void gl_compute(const struct gl *gl, int width, int height);

#endif
