// texture.h - what relit views show of a surface, as a picture that lies on it
#ifndef FUSION_TEXTURE_H
#define FUSION_TEXTURE_H

#include "shape/fusion/witness.h"

#include <relume/renderer.h>
#include <relume/shape/mesh.h>

struct texture {
    relume_renderer *renderer;  // under the lights that it is to show
    const struct witness *witness;
    int witnesses;
    double near;  // as seen_weight
    int side;     // of the picture, texels
    int threads;
    const struct relume_log *log;
};

// The mesh gets texture coordinates: vertices at borders of charts become several. `*picture` is
// created, linear; texels that nobody sees, and those beside charts, take what is around them.
// RELUME_EUNFIT with a sentence (too small for all charts), errors of relume_renderer_frame,
// RELUME_ENOMEM, RELUME_ECANCEL; then `*picture` is empty.
relume_status texture_make(struct relume_mesh *mesh, struct relume_image *picture,
                           const struct texture *t);

// How near the mesh in its colours is to the relit views: in the display coding of sRGB, over
// pixels that show it. `picture` NULL: in the colours of its vertices. `*shown` is the share of the
// pixels with a surface. Errors as above, RELUME_ESYSTEM.
relume_status texture_judge(double *psnr_db, double *shown, const struct relume_mesh *mesh,
                            const struct relume_image *picture, const struct texture *t);

#endif
