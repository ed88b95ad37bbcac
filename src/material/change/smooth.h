// smooth.h - pictures smoothed by a Gaussian
#ifndef CHANGE_SMOOTH_H
#define CHANGE_SMOOTH_H

#include <relume/image.h>

// In place, of deviation `sigma` pixels, at most 16; what lies beyond the edge does not count.
// RELUME_ENOMEM.
relume_status smooth(struct relume_image *image, double sigma, int threads);
// The same of pixels where `known` (one channel, 0 or 1) is 1 alone; the others become 0.
relume_status smooth_known(struct relume_image *image, const struct relume_image *known,
                           double sigma, int threads);
// `*out` is a new picture: smoothed, and of both.
relume_status smooth_copy(struct relume_image *out, const struct relume_image *image, double sigma,
                          int threads);

#endif
