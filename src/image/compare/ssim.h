// ssim.h - structural similarity of two grey planes (Wang, Bovik, Sheikh, Simoncelli 2004)
#ifndef COMPARE_SSIM_H
#define COMPARE_SSIM_H

#include <stddef.h>

struct ssim_sum {
    double sum;
    size_t windows;
};

// How many doubles ssim_rows needs for planes of this width.
size_t ssim_scratch(int width);

// Over the windows whose centres lie in the rows [first, end): 11 x 11 Gaussian, sigma 1.5, only
// windows wholly inside the planes, as in the paper's own program. Values in [0, 1]; `mask` (may be
// NULL) takes centres where it is above 0.5.
struct ssim_sum ssim_rows(const float *a, const float *b, const float *mask, int width, int height,
                          int first, int end, double *scratch);

#endif
