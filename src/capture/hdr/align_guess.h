// align_guess.h - how two exposures of one scene lie on each other, about
#ifndef HDR_ALIGN_GUESS_H
#define HDR_ALIGN_GUESS_H

#include <relume/capture/align.h>

// The homography (relume_align_homography) of the two exposures made small. `correlation` is 0
// where they have nothing in common. RELUME_ENOMEM.
relume_status align_guess(struct relume_homography *out, const struct relume_image *anchor,
                          const struct relume_image *image, int threads);

#endif
