// planted.h - a g-BRDF of which everything is known: the truth that fits are held against
#ifndef GBRDF_PLANTED_H
#define GBRDF_PLANTED_H

#include "material/gbrdf/gbrdf.h"

enum { PLANTED_MATERIALS = 3 };

// Fill maps of PLANTED_MATERIALS materials, whose sizes and arrays are there.
void gbrdf_plant(struct gbrdf_maps *maps, uint64_t seed);

#endif
