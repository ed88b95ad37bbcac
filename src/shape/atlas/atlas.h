// atlas.h - a mesh flattened onto a picture: which place of which triangle each texel holds
#ifndef SHAPE_ATLAS_H
#define SHAPE_ATLAS_H

#include "shape/atlas/charts.h"

// What a texel holds; texels within one and a half of a triangle hold its nearest place, so that
// what is between texels is always known.
struct atlas_texel {
    uint32_t triangle;  // UINT32_MAX: nothing
    float u, v;         // weights of its second and third corner
};

struct atlas {
    int width, height;
    struct atlas_texel *texel;
    size_t used;  // texels that hold something
    int charts;   // 0: the places were those of the mesh
};

// Texels for `n` triangles whose places are set: the mesh's own, where these lie within the picture
// and no two triangles on the same texel; else places are made, and set. Triangles become charts of
// neighbours that face the same of six ways, seen from there, which are packed in rows. Charts of
// fewer texels than `small`, about, become parts of larger ones beside them where they can; 0:
// none. RELUME_EUNFIT with a sentence where the picture is too small for all charts, RELUME_ENOMEM.
relume_status atlas_make(struct atlas *out, struct atlas_corner (*triangle)[3], size_t n, int width,
                         int height, double small, const struct relume_log *log);
void atlas_free(struct atlas *atlas);

#endif
