// detail.c - how sharp a photograph is, whatever its light
//
// Curvature of the logarithm of light from pixel to pixel, relative to its differences over a
// thirtieth of the picture: brightness changes neither, blur takes the first and leaves the second.
#include "capture/acquire/acquire.h"

#include "capture/acquire/ball.h"

enum { COARSE = 30 };              // of the picture's larger side
enum { ENOUGH = 1 << 20 };         // pixels: larger pictures are sampled
static const float FLOOR = 5e-3f;  // where noise rules

static float tone(const struct relume_image *image, int x, int y)
{
    return logf(FLOOR + fmaxf(ball_grey(image, x, y), 0.0f));
}

void acquire_measure_detail(struct shot *shot, const struct relume_image *image)
{
    const int w = image->width, h = image->height, side = w > h ? w : h;
    const int far = side / COARSE > 4 ? side / COARSE : 4;
    double fine = 0.0, coarse = 0.0;
    size_t n = 0;
    int apart = 1;
    while ((int64_t)w * h > (int64_t)ENOUGH * apart * apart)
        apart++;
    for (int y = 1; y + far < h; y += 3 * apart)
        for (int x = 1; x + far < w; x += 2 * apart, n++) {
            const float v = tone(image, x, y);
            const float u = tone(image, x - 1, y) - 2.0f * v + tone(image, x + 1, y);
            const float t = tone(image, x, y - 1) - 2.0f * v + tone(image, x, y + 1);
            const float a = tone(image, x + far, y) - v, b = tone(image, x, y + far) - v;
            fine += (double)(u * u + t * t);
            coarse += (double)(a * a + b * b);
        }
    shot->fine = n ? fine / (double)n : 0.0;
    shot->coarse = n ? coarse / (double)n : 0.0;
}
