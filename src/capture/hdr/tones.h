// tones.h - one exposure made to look like another
#ifndef HDR_TONES_H
#define HDR_TONES_H

#include <relume/image.h>

// `out` is `image` with the distribution of code values of `like`, per channel: what saturates
// there saturates here (Grossberg, Nayar 2003: histograms of one scene determine the brightness
// transfer whatever moves).
relume_status tones_match(struct relume_image *out, const struct relume_image *image,
                          const struct relume_image *like, int threads);

#endif
