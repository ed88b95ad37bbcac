// reduction.h - the coefficients of a view at half its size
#ifndef ENCODE_REDUCTION_H
#define ENCODE_REDUCTION_H

#include "format/coder/coding.h"

#include <relume/format/coder.h>

// Half of a side; an odd one keeps its last pixel.
static inline int reduced(int side)
{
    return (side + 1) / 2;
}

// What coefficients are in, and how they will be stored: domain, not AUTO, and its curve;
// storage, step, threads and the place of temporary data.
struct reduction {
    enum relume_domain domain;
    struct relume_transfer display;
    struct relume_project_params encode;
};

// Coefficients whose pixels show, under the captured lights, the mean light of the 2 x 2 that they
// cover. `share` (empty: 1) is how much of each pixel of `from` is within the mask: nothing shows
// beyond it. Not of luminance coefficients, which are no sums. RELUME_EIO, RELUME_ENOMEM.
relume_status coefficients_reduce(relume_coefficients **out, const relume_coefficients *from,
                                  const struct relume_image *share, const struct reduction *r);
// Of each pixel, whether the mask holds it: 0 or 1; and the means of 2 x 2 shares. RELUME_EIO,
// RELUME_ENOMEM.
relume_status share_create(struct relume_image *out, const struct relume_image *mask,
                           const struct relume_project_params *p);
relume_status share_reduce(struct relume_image *out, const struct relume_image *share,
                           const struct relume_project_params *p);

#endif
