// grow.h - what the ways of growing a texture share
#ifndef SYNTHESIS_GROW_H
#define SYNTHESIS_GROW_H

#include "material/synthesis/regular.h"

enum { GROW_VALUES = 8 };  // floats of a texel that are compared, at most

// A map that is made. Parameters are checked and filled in.
struct grow {
    const struct relume_texture *texture;
    const struct relume_regular *regular;  // or NULL
    const struct relume_grow_params *params;
    double stretch_x, stretch_y;  // of the structure, so that whole periods fit into a tile
    int width, height;
    uint32_t *texel;  // [height][width]
    int values;       // 4 or GROW_VALUES
    float *value;     // [texels of the sample][values], zeros behind the channels
};

// Texel by texel; patch by patch. RELUME_ENOMEM, RELUME_ECANCEL.
relume_status grow_pixels(struct grow *g);
relume_status grow_patches(struct grow *g);

#endif
