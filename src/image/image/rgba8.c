// rgba8.c - linear light to sRGB-coded bytes
#include "image/image/rgba8.h"

#include <relume/image.h>

#include <math.h>
#include <string.h>

void byte_coder_init(struct byte_coder *coder, float gain)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    coder->gain = gain;
    for (int i = 0; i < BYTE_STEPS + 2; i++) {
        const float root = (float)i / BYTE_STEPS;
        coder->value[i] = 255.0f * relume_transfer_encode(srgb, root * root) + 0.5f;
    }
}

static inline uint8_t code(const struct byte_coder *coder, float linear)
{
    const float v = linear * coder->gain;
    const float x = sqrtf(v > 0.0f ? v < 1.0f ? v : 1.0f : 0.0f) * BYTE_STEPS;
    const int i = (int)x;
    return (uint8_t)(coder->value[i] + (x - (float)i) * (coder->value[i + 1] - coder->value[i]));
}

void byte_code(uint32_t *out, const float *rgb, size_t n, const struct byte_coder *coder)
{
    for (size_t i = 0; i < n; i++) {
        const uint8_t pixel[4] = {code(coder, rgb[3 * i]), code(coder, rgb[3 * i + 1]),
                                  code(coder, rgb[3 * i + 2]), 255};
        memcpy(&out[i], pixel, sizeof pixel);
    }
}
