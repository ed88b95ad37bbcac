// plane_sweep_picture.c - a photograph as planes of bytes, made smaller
#include "capture/multiview/plane_sweep_picture.h"

#include <math.h>

int plane_sweep_factor(int width, int most)
{
    return (width + most - 1) / most;
}

// Mean of a block in linear light; the square root approximates display coding.
static uint8_t block_value(const struct relume_image *image, int x, int y, int c, int factor)
{
    float sum = 0.0f;
    for (int j = 0; j < factor; j++) {
        const size_t at = (size_t)(y * factor + j) * (size_t)image->width + (size_t)(x * factor);
        const float *row = image->data + at * (size_t)image->channels + c;
        for (int i = 0; i < factor; i++)
            sum += row[(size_t)i * (size_t)image->channels];
    }
    const float mean = sum / (float)(factor * factor);
    return (uint8_t)lrintf(255.0f * sqrtf(fminf(fmaxf(mean, 0.0f), 1.0f)));
}

void plane_sweep_picture(uint8_t *out, const struct relume_image *image, int factor)
{
    const int width = image->width / factor, height = image->height / factor;
    for (int c = 0; c < image->channels; c++)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++)
                *out++ = block_value(image, x, y, c, factor);
}
