// slab_drawer.h - frames of an eye in front of one slab, or of several
#ifndef VIEWER_SLAB_DRAWER_H
#define VIEWER_SLAB_DRAWER_H

#include "draw/draw.h"
#include "draw/view_parts.h"

struct slab_drawer {
    const struct gl *gl;
    const struct relume_log *log;
    struct program slab, slab_depth, slab_lens, slabs, slabs_depth, mean;
    // Sums of weighted values, made when first needed: `sum` has an aperture's cameras or several
    // slabs, `beside` rays that pass the cameras of no slab, `pinholes` a lens in front of several.
    struct target sum, beside, pinholes;
};

// RELUME_ESYSTEM.
relume_status slab_drawer_create(struct slab_drawer *d, const struct gl *gl,
                                 const struct relume_log *log);
void slab_drawer_destroy(struct slab_drawer *d);
// Draws the frame of an eye from relit views, or parts of them, into `frame`, which is in use.
// RELUME_ESYSTEM, RELUME_ENOMEM, errors of the source of depth.
relume_status slab_drawer_draw(struct slab_drawer *d, struct file_views *views,
                               const struct view_parts *parts, const struct frame_request *q,
                               const struct frame_area *area, const struct target *frame);

#endif
