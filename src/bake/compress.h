// compress.h - all texels of a baking
#ifndef BAKE_COMPRESS_H
#define BAKE_COMPRESS_H

#include "bake/texel.h"

// What each texel sends to others: straight light, and what of it has gone from surface to surface
// fewer times than there are bounces. RELUME_ENOMEM, RELUME_ECANCEL, RELUME_ELIMIT.
relume_status bake_bounces(struct baking *b);

// Fill a baked object that is described: learn components from some texels, then all texels as
// these. Fewer clusters where there are fewer texels. The same.
relume_status bake_compress(relume_baked *out, const struct baking *b);

#endif
