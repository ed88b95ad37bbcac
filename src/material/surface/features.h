// features.h - few numbers for each texel, in which texels that look alike are near
#ifndef SURFACE_FEATURES_H
#define SURFACE_FEATURES_H

#include "material/model/model.h"

enum { FEATURES = 12 };

struct features {
    int width, height;
    float (*texel)[FEATURES];  // [height][width]
};
// RELUME_ENOMEM.
relume_status features_make(struct features *out, const relume_btf_fitted *sample, int threads);
void features_free(struct features *f);

// The squared difference of two texels: the mean over pictures and colours, in display coding.
static inline float features_apart(const struct features *f, size_t a, size_t b)
{
    float sum = 0.0f;
    for (int k = 0; k < FEATURES; k++) {
        const float d = f->texel[a][k] - f->texel[b][k];
        sum += d * d;
    }
    return sum;
}

#endif
