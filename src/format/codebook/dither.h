// dither.h - contours of a codebook, broken into a pattern within a budget of bytes
//
// Contours (Wong 1998, Fig 9-11) arise where a smooth ramp crosses from one code to the next. In a
// band along such an edge, pixels take the two codes in turns, in blocks of 2 x 2: one step becomes
// two of half the height. (Blocks cost a third of what an ordered pattern of single pixels costs in
// PIZ, and take three quarters of its effect.) Bands between the same two codes are one contour;
// the longest are taken first, until the bytes that the indices may grow by are spent. Errors are
// not handed on from pixel to pixel (Floyd and Steinberg 1976): what lies off the segment between
// two codes can never be made good.
#ifndef CODEBOOK_DITHER_H
#define CODEBOOK_DITHER_H

#include <relume/base.h>

struct dither {
    const float *vectors;  // [codes][planes]
    int codes;
    size_t planes, width, height;
    double share;  // of the indices' bytes that the pattern may add, about; 1: as many as it takes
    int *neighbour;   // [codes][8]: the nearest codes, itself where there are not as many
    uint16_t *other;  // [height][width]: what a pixel may take in turns, its own code where nothing
};

// `vectors` are borrowed. RELUME_ENOMEM.
relume_status dither_open(struct dither *d, const float *vectors, int codes, size_t planes,
                          size_t width, size_t height, double share, int threads);
void dither_close(struct dither *d);
// Whether pixel (x, y), whose vector is `own`[planes], lies in a band; row[planes][width] are the
// vectors of its row. Rows may be offered from several threads.
void dither_offer(const struct dither *d, size_t x, size_t y, uint16_t code, const float *own,
                  const float *row);
// The longest contours for their bytes, into index[height][width]. RELUME_ENOMEM.
relume_status dither_spend(const struct dither *d, uint16_t *index);

#endif
