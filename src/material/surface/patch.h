// patch.h - squares of a sample pasted into a tile that repeats
#ifndef SURFACE_PATCH_H
#define SURFACE_PATCH_H

#include "material/surface/features.h"

enum { PATCH_BORDER = 2 };  // texels that all tiles have in common on each side
#define PATCH_EMPTY UINT32_MAX

// A square of the sample at (sx, sy) for the torus at (x, y). Its middle, `core` texels in from the
// rim, replaces what is there while the border of the tile stays; core 0: what is empty must be
// filled.
struct patch {
    int x, y, size, core;
    int sx, sy;
};

struct canvas {
    const struct features *f;
    int side, threads;
    uint32_t *texel;  // [side][side] of the tile that is made
    float unit;       // the squared step between neighbours in the sample
    // Patches with a core that are there already, so that tiles differ.
    struct patch *used;
    int used_count;
};

// Choose (sx, sy) and paste along the cheapest cut of some places that fit well; `seed` decides
// between equals. RELUME_ENOMEM.
relume_status patch_paste(struct canvas *c, struct patch *patch, uint64_t seed);

#endif
