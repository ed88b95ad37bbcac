// trellis.h - DCT coefficients quantised for the least distortion + lambda x bits
#ifndef IMAGE_TRELLIS_H
#define IMAGE_TRELLIS_H

#include <relume/base.h>

// Number of 8 x 8 blocks that cover a plane.
size_t trellis_blocks(int width, int height);

// Orthonormal DCT of every block, zigzag order: out[blocks][64]. The border is repeated outwards.
void trellis_transform(const float *plane, int width, int height, float *out);

struct trellis_result {
    double distortion;  // sum of squared errors over the blocks
    double bits;        // by the entropy of what a progressive scan codes
};

// Quantise by one flat `step` into codes [-1023, 1023]. `lambda` is in units of step^2 per bit; 0
// rounds to the nearest.
struct trellis_result trellis_quantise(const float *dct, size_t blocks, double step, double lambda,
                                       int16_t *codes);

#endif
