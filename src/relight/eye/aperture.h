// aperture.h - an eye's aperture as a picture of transmittance
//
// Every primitive covers texels by exact area along x and by many scan lines along y, so that
// what moves by a fraction of a texel changes the picture, and its transform, smoothly.
#ifndef POST_APERTURE_H
#define POST_APERTURE_H

#include "relight/eye/pupil.h"

#include <relume/relight/eye.h>

// A square picture, texel (n / 2, n / 2) centred on the axis, row 0 at the top.
struct canvas {
    int n;
    double texel_mm;
    float *t;      // [n][n]; outside rows [from, to) there is no light
    float *fixed;  // [n][n]: cornea and fibres, drawn once; NULL: not drawn yet
    uint64_t key;  // of the primitives in `fixed`
    int from, to;
    double light;  // share of the pupil that the lids leave open
};

relume_status canvas_resize(struct canvas *canvas, int n, double texel_mm);
void canvas_destroy(struct canvas *canvas);

// Draw all but the parts in `parts_off` (RELUME_EYE_*), which stay the same. RELUME_ENOMEM.
relume_status canvas_draw(struct canvas *canvas, const struct relume_aperture *aperture,
                          unsigned parts_off, int threads);

// Multiply `t[n][n]` by what the given discs let through, each moved away from the axis by `scale`.
// RELUME_ENOMEM.
relume_status canvas_discs(struct canvas *canvas, float *t, const struct relume_eye_disc *discs,
                           int count, double scale, int threads);

#endif
