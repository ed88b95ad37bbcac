// foreign_pixel.h - what a viewer of other formats shows of a pixel, by their definition
#ifndef FOREIGN_PIXEL_H
#define FOREIGN_PIXEL_H

#include "exchange/foreign/foreign.h"

// The value of a pixel for weights and constants of foreign_weights.
static inline void foreign_pixel(const struct foreign *f, size_t pixel, const double *weights,
                                 const double constant[3], double rgb[3])
{
    const int k = f->terms;
    for (int c = 0; c < 3; c++) {
        const double *w = weights + (size_t)c * (size_t)k;
        rgb[c] = constant[c];
        for (int i = 0; i < k; i++)
            rgb[c] +=
                w[i] * foreign_coefficient(f, f->form == FOREIGN_CHANNELS ? 3 * i + c : i, pixel);
        if (f->form == FOREIGN_LUMINANCE)
            rgb[c] *= foreign_coefficient(f, k + c, pixel);
    }
}

#endif
