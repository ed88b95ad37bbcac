// gl_aperture.h - the aperture of an eye as a texture of transmittance, drawn with blending that
// multiplies
#ifndef VIEWER_GL_APERTURE_H
#define VIEWER_GL_APERTURE_H

#include "gl/program.h"
#include "relight/eye/pupil.h"

#include <relume/relight/eye.h>

// Row 0 of the square textures is the top, texel (size / 2, size / 2) is centred on the axis.
struct gl_aperture {
    int size;
    double texel_mm;
    unsigned parts_off;
    GLuint texture;  // R32F
    GLuint fixed;    // R32F: cornea and fibres
    bool drawn;      // `fixed` is
    GLuint framebuffer, vertices, buffer;
    struct program disc, stroke, opening;
    int from, to;  // rows outside hold no light
    double light;  // share of the pupil that the lids leave open
};

// RELUME_ESYSTEM when the machine cannot draw into such a texture.
relume_status gl_aperture_create(struct gl_aperture *aperture, const struct gl *gl, int size,
                                 double texel_mm, unsigned parts_off, const struct relume_log *log);
void gl_aperture_destroy(struct gl_aperture *aperture, const struct gl *gl);
// Draw that moment of one eye: what never moves in it is drawn once.
void gl_aperture_draw(struct gl_aperture *aperture, const struct gl *gl,
                      const struct relume_aperture *moment);

// The share of the pupil between the lids.
double gl_aperture_light(const struct relume_aperture *moment);

#endif
