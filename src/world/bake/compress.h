// compress.h - all texels of a baking
#ifndef BAKE_COMPRESS_H
#define BAKE_COMPRESS_H

#include "world/bake/texel.h"

// What each texel sends to others: straight light, and what of it has gone from surface to surface
// fewer times than there are bounces. RELUME_ENOMEM, RELUME_ECANCEL, RELUME_ELIMIT.
relume_status bake_bounces(struct baking *b);

// How many texels components are learned from; there are no more clusters than these allow.
size_t bake_count_taught(relume_baked *out, const struct baking *b);

// Fill a baked object that is described: learn components from some texels, then all texels as
// these. The same.
relume_status bake_compress(relume_baked *out, const struct baking *b);

#endif
