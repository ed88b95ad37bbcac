// cells.h - the surface through single cells of a grid: blocks of one sample
#ifndef ISOSURFACE_CELLS_H
#define ISOSURFACE_CELLS_H

#include "shape/volume/signs.h"

// `*out` is empty before. RELUME_ENOMEM, RELUME_ELIMIT; what is made then is the caller's to free.
relume_status cells_mesh(struct relume_mesh *out, struct relume_isosurface_report *report,
                         const struct signs *g);

#endif
