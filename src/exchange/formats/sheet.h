// sheet.h - up to three planes as one JPEG, quantised by steps in the planes' own units
//
// The quantiser of a plane is uniform and flat: for principal components equal steps for all
// coefficients of all planes are the rate-distortion optimum (reverse water-filling), and no eye
// looks at a coefficient plane.
#ifndef EXCHANGE_SHEET_H
#define EXCHANGE_SHEET_H

#include <relume/base.h>

enum { SHEET_PLANES = 3 };

// Squared steps per bit that a coefficient may cost: the high-rate slope of a uniform quantiser,
// 2 ln 2 / 12. Tried: 0.10 does as well, 0.14 and 0.20 a few hundredths of a decibel worse.
#define SHEET_LAMBDA 0.1155

struct sheet {
    int width, height;
    int planes;                        // 1 to 3, a missing one is a constant
    const float *plane[SHEET_PLANES];  // [height][width]
    double minimum[SHEET_PLANES], maximum[SHEET_PLANES];
    double weight[SHEET_PLANES];  // error of the picture that a unit of error makes
    bool own;                     // each plane has its own unit, whatever the others' ranges are
    bool fixed;                   // codes are 255 x value: no scale of their own
    bool ycbcr;                   // red, green and blue of one thing
    bool blocks;                  // report every block
};

// Squares of the picture's values, summed over the channels, in a block of 8 x 8 pixels.
struct sheet_block {
    float error;    // what quantising loses
    float energy;   // what leaving the sheet out loses
    float texture;  // without the block's mean
};

struct sheet_result {
    uint8_t *bytes;  // from malloc
    size_t size;
    double scale[SHEET_PLANES], bias[SHEET_PLANES];  // value = (code / 255 - bias) * scale
    double distortion[SHEET_PLANES];                 // weighted squared error, mean over the pixels
    struct sheet_block *block;                       // from malloc, NULL: not asked for
};

// `step`: in units of the picture's error. RELUME_ENOMEM.
relume_status sheet_encode(struct sheet_result *out, const struct sheet *sheet, double step);

#endif
