// between_white.h - objects under a white sky: how much of the light on them they return
#ifndef VIEWER_BETWEEN_WHITE_H
#define VIEWER_BETWEEN_WHITE_H

#include "draw/objects_drawer.h"

// Zeroed it holds nothing.
struct between_white {
    struct relume_image map;
    relume_environment *sky;
    struct target objects;  // as large as their surface
    uint64_t of;            // fingerprint of the materials in it; 0: nothing is drawn yet
    float clip[16];         // matrix that it is seen by
};

// RELUME_ENOMEM.
relume_status between_white_create(struct between_white *w);
void between_white_destroy(struct between_white *w, const struct gl *gl);
// Draws the objects, whose surface is drawn and whose materials have that fingerprint, unless they
// are there. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status between_white_need(struct between_white *w, struct objects_drawer *drawer,
                                 const struct frame_projection *projection, uint64_t materials);

#endif
