// on_gbrdf.h - the operations on a g-BRDF
#ifndef EDIT_ON_GBRDF_H
#define EDIT_ON_GBRDF_H

#include "material/gbrdf/gbrdf.h"

#include <relume/material/edit.h>

enum { GBRDF_MOST_MATERIALS = 64 };

// What is edited.
struct edited_gbrdf {
    struct gbrdf_maps maps;              // with memory of their own (material/gbrdf/fit.h)
    bool touched[GBRDF_MOST_MATERIALS];  // whose energy must be looked at
    const struct relume_log *log;
};

// Each RELUME_EUNFIT with a sentence for what the g-BRDF has not, or RELUME_ENOMEM.
relume_status gbrdf_emboss(struct edited_gbrdf *g, const struct relume_edit *edit);
relume_status gbrdf_engrave(struct edited_gbrdf *g, const struct relume_edit *edit);
relume_status gbrdf_roughness(struct edited_gbrdf *g, const struct relume_edit *edit);
relume_status gbrdf_tint(struct edited_gbrdf *g, const struct relume_edit *edit);
relume_status gbrdf_channels(struct edited_gbrdf *g, const struct relume_edit *edit);
relume_status gbrdf_swap(struct edited_gbrdf *g, const struct relume_edit *edit);
relume_status gbrdf_turn(struct edited_gbrdf *g, const struct relume_edit *edit);
relume_status gbrdf_add_material(struct edited_gbrdf *g, const struct relume_edit *edit);

#endif
