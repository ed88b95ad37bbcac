// regular.h - the inside of what is known of a texture's structure
#ifndef SYNTHESIS_REGULAR_H
#define SYNTHESIS_REGULAR_H

#include <relume/material/synthesis.h>

enum { REGULAR_CHANNELS = 3, MASK_VALUES = 4 };

struct relume_regular {
    struct relume_regular_info info;
    struct relume_wave *wave;
    int width, height, channels;  // of the sample; at most REGULAR_CHANNELS
};

// A rectangle of the mask, whose texels may lie `spacing` apart and be stretched: texel (i, j) is
// the sample's place ((x + i) spacing stretch_x, ...).
struct mask_area {
    int x, y, width, height;
    double spacing, stretch_x, stretch_y;
};
// out[height][width][MASK_VALUES], without the means and in values of the texture: the first
// channel and what it is a quarter of a period on, then the second and third channel. `scratch`
// holds 2 (width + height) doubles.
void mask_fill(float *out, const struct relume_regular *r, const struct mask_area *area,
               double *scratch);
// That of the whole sample, [texels][MASK_VALUES]; NULL: no memory.
float *mask_of_sample(const struct relume_regular *r);

#endif
