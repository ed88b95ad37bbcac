// alike.h - for each texel those whose surroundings look most like its own
#ifndef SYNTHESIS_ALIKE_H
#define SYNTHESIS_ALIKE_H

#include <relume/base.h>

// Texels [height][width], each a number of floats to compare, and some that count by themselves:
// the surroundings are side x side texels, `spacing` apart.
struct alike_texels {
    int width, height;
    const float *value;  // [height][width][values]
    int values;
    const float *own;  // [height][width][owns], or NULL
    int owns;
    float weight;  // of a square of these, beside one of the surroundings
    int side, spacing;
};

// out[height * width][count]: texels at least `apart` away in x or y, the most alike first; a texel
// itself where there is none. Surroundings are compared by a few principal components.
// RELUME_ENOMEM.
relume_status alike_find(uint32_t *out, int count, int apart, const struct alike_texels *t,
                         int threads);

#endif
