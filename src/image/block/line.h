// line.h - the line in colour space along which the pixels of a block are placed
#ifndef BLOCK_LINE_H
#define BLOCK_LINE_H

#include "image/block/block.h"

struct line {
    float end[2][3];  // 0 to the highest
};

void line_values(float out[BLOCK_PIXELS][3], const uint8_t (*rgb)[3]);

// Along the principal axis of the pixels, as far as they reach.
struct line line_fit(const float (*rgb)[3], float highest);
// The least squares' line for pixels at the parts `at` of it, 0 to 1. False where they all stand in
// one place.
int line_refit(struct line *out, const float (*rgb)[3], const float at[BLOCK_PIXELS],
               float highest);

// The colour of `palette` that is nearest to each pixel; the sum of squared errors.
int line_nearest(uint8_t index[BLOCK_PIXELS], const int (*palette)[3], int colours,
                 const uint8_t (*rgb)[3]);

#endif
