// apply.h - all edits of a list
#ifndef EDIT_APPLY_H
#define EDIT_APPLY_H

#include "material/gbrdf/gbrdf.h"

#include <relume/material/edit.h>

// All edits that are not undone, in `maps`, which have memory
// of their own (material/gbrdf/fit.h); then no texel sends back more than it gets.
// RELUME_EUNFIT with a sentence, RELUME_ENOMEM.
relume_status edit_gbrdf(struct gbrdf_maps *maps, const relume_edits *edits,
                         const struct relume_log *log);

#endif
