// align.h - bring photographs of one scene on top of each other, and find what moved
//
// All images have three channels and the size of the anchor. For brackets they are code values; for
// light sequences linear light.
#ifndef RELUME_ALIGN_H
#define RELUME_ALIGN_H

#include <relume/base.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

// The image that the others are aligned to: of highest entropy (8-bit luma, Shannon).
RELUME_API int relume_align_anchor(const struct relume_image *images, int n);

struct relume_align_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;          // default: all cores
    int block;            // side of the smallest macroblock, a power of two; default 16
    double max_roll_deg;  // homography: rolls that are tried at the start; default 12
};
#define relume_align_params(...)                                                                   \
    (&(const struct relume_align_params){RELUME_SIZED(relume_align_params), __VA_ARGS__})

// Where the pixels of the anchor lie in another image.
struct relume_displacements {
    int width, height;  // of the images
    int columns, rows;  // of the nodes
    double step;        // pixels between nodes; node (0, 0) lies at `origin`, pixels
    double origin[2];   // pixels of the anchor
    float (*d)[2];  // [rows][columns], pixels, from malloc: pixel p of the anchor is p + d there
};
// Hierarchical macroblocks (exposure brackets held by hand): normalised correlation of sharpened
// pictures, searched from one block of the whole picture down to blocks of 16 pixels; survives
// rolls up to about 14 degrees, moving things and parallax. A roll that a homography of small
// pictures shows is undone first. Blocks above 64 pixels are compared on a pyramid of the picture.
// RELUME_EINVAL for wrong sizes, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_align_blocks(struct relume_displacements *out,
                                                const struct relume_image *anchor,
                                                const struct relume_image *image,
                                                const struct relume_align_params *params);
RELUME_API void relume_displacements_destroy(struct relume_displacements *displacements);
// The displacement of a place, bilinear between the nodes.
RELUME_API void relume_displacements_at(const struct relume_displacements *displacements, double x,
                                        double y, double d[2]);

// Pixel coordinates (centres at +0.5) of the anchor -> of the image: (x, y, 1) -> m (x, y, 1).
struct relume_homography {
    double m[3][3];      // m[2][2] = 1
    double correlation;  // of what was aligned, [-1, 1]; below about 0.3 the scenes differ
};
// One homography for static scenes, also under changing light: enhanced correlation (Evangelidis,
// Psarakis 2008, Eq. 20) of gradient magnitudes that are normalised by their surroundings, coarse
// to fine. RELUME_EINVAL for wrong sizes, RELUME_EUNFIT when the picture has no detail,
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_align_homography(struct relume_homography *out,
                                                    const struct relume_image *anchor,
                                                    const struct relume_image *image,
                                                    const struct relume_align_params *params);

// The image as the anchor's camera would have seen it, bilinear. `valid` (or NULL) gets one
// channel, 1 where the place lies inside the image, else 0 (there the nearest pixel is repeated).
RELUME_RESULT relume_status relume_warp_displacements(struct relume_image *out,
                                                      struct relume_image *valid,
                                                      const struct relume_image *image,
                                                      const struct relume_displacements *d,
                                                      const struct relume_align_params *params);
// The same through a homography. RELUME_EINVAL for wrong sizes, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_warp_homography(struct relume_image *out,
                                                   struct relume_image *valid,
                                                   const struct relume_image *image,
                                                   const struct relume_homography *h,
                                                   const struct relume_align_params *params);

// How alike two pictures are whatever their exposure: the correlation of their normalised gradient
// magnitudes where they are, [-1, 1]. Exposures of one scene reach 0.3 and more, of others about 0.
// NaN when one shows no detail, when sizes differ or memory is short.
RELUME_API double relume_edge_correlation(const struct relume_image *a,
                                          const struct relume_image *b);

// How ghosts are found. Borrowed during the call.
struct relume_ghost_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    int threads;          // default: all cores
    double threshold;     // least correlation of 11 x 11 pixels; default 0.985
    double black, white;  // codes beyond resolve nothing; default 0.05, 0.95
};
#define relume_ghost_params(...)                                                                   \
    (&(const struct relume_ghost_params){RELUME_SIZED(relume_ghost_params), __VA_ARGS__})

// masks[i], one channel: 0 where image i of an aligned bracket disagrees with its reference,
// else 1. The reference of a pixel is the anchor, or where that is black or saturated the next
// exposure towards image i that is not; what only image i resolves stays. masks[anchor] is all 1.
// On failure all masks are empty. RELUME_EINVAL for wrong sizes, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_ghost_masks(struct relume_image *masks,
                                               const struct relume_image *codes,
                                               const double *exposures, int n, int anchor,
                                               const struct relume_ghost_params *params);

#ifdef __cplusplus
}
#endif
#endif
