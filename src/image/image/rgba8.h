// rgba8.h - linear light to sRGB-coded bytes, fast enough for every pixel of a frame
#ifndef IMAGE_RGBA8_H
#define IMAGE_RGBA8_H

#include <stddef.h>
#include <stdint.h>

enum { BYTE_STEPS = 1024 };

// 255 x the sRGB curve over the square root of the value, where straight pieces follow it to 1e-5.
struct byte_coder {
    float gain;
    float value[BYTE_STEPS + 2];
};

void byte_coder_init(struct byte_coder *coder, float gain);
// out[i]: red, green, blue, 255 in memory order, of rgb[i][3] x gain clipped to [0, 1]; NaN is 0.
void byte_code(uint32_t *out, const float *rgb, size_t n, const struct byte_coder *coder);

#endif
