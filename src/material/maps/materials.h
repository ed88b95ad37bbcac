// materials.h - the codebook of gloss, learned from pixels all over the picture
#ifndef APPEARANCE_MATERIALS_H
#define APPEARANCE_MATERIALS_H

#include "material/maps/fit.h"

#include <relume/material/maps.h>

// A pixel that the codebook is learned from.
struct learner {
    struct look look;
    float matte[3], albedo[3];  // normal and colour of a matte surface
    float normal[3];            // as the material that it has now takes it
    int material;
};

struct materials {
    int count;
    struct gloss gloss[RELUME_MAPS_MOST_MATERIALS];
};

// The fewest materials, at most `most`, with which the pixels are about as well explained as they
// can be; the matte one alone where `matte`. RELUME_ENOMEM.
relume_status materials_learn(struct materials *out, struct learner *learner, size_t learners,
                              int most, bool matte, int threads);

#endif
