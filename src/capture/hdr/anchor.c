// anchor.c - the exposure that shows most
#include <relume/capture/align.h>

#include "core/math/luminance.h"

#include <math.h>

enum { MOST = 1 << 20 };  // pixels that are counted

static double entropy(const struct relume_image *image)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    const size_t step = pixels / MOST + 1, all = (pixels + step - 1) / step;
    size_t count[256] = {0};
    double bits = 0.0;
    for (size_t i = 0; i < pixels; i += step) {
        const float *p = image->data + 3 * i;
        const float luma = luma_601f(p);
        count[luma >= 1.0f ? 255 : luma > 0.0f ? (int)(luma * 255.0f + 0.5f) : 0]++;
    }
    for (int z = 0; z < 256; z++)
        if (count[z]) {
            const double part = (double)count[z] / (double)all;
            bits -= part * log2(part);
        }
    return bits;
}

int relume_align_anchor(const struct relume_image *images, int n)
{
    int best = 0;
    double most = -1.0;
    for (int i = 0; i < n; i++) {
        const double bits = entropy(&images[i]);
        if (bits > most) {
            most = bits;
            best = i;
        }
    }
    return best;
}
