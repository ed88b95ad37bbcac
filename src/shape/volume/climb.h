// climb.h - the surface through boxes of a grid: adaptive skeleton climbing
#ifndef ISOSURFACE_CLIMB_H
#define ISOSURFACE_CLIMB_H

#include "shape/volume/signs.h"

// Boxes within blocks of `block` samples, 2 to 16. `share`: lines on faces are those of both
// neighbours; without there are cracks, which tests want to find. `*out` is empty before.
// RELUME_ENOMEM, RELUME_ELIMIT, RELUME_ECANCEL; what is made then is the caller's to free.
relume_status climb_mesh(struct relume_mesh *out, struct relume_isosurface_report *report,
                         const struct signs *g, int block, bool share);

#endif
