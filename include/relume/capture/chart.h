// chart.h - a colour target in a photograph: where it is, and the matrix that makes its colours
// right
//
// The target is a ColorChecker 24 (McCamy, Marcus, Davidson 1976: six by four patches, the last row
// grey from white to black). Its patches in linear light, as the camera sees them, and their
// published colours give white balance and a 3 x 3 matrix.
#ifndef RELUME_CHART_H
#define RELUME_CHART_H

#include <relume/base.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { RELUME_CHART_COLUMNS = 6, RELUME_CHART_ROWS = 4, RELUME_CHART_PATCHES = 24 };

// One patch, counted row by row from "dark skin" to "black".
struct relume_chart_patch {
    const char *name;        // constant
    double place[2];         // its middle, pixels from the upper left
    float found[3];          // mean as photographed, linear light
    float is[3];             // what it should be, linear sRGB
    double noise;            // standard deviation of its luminance, relative to the mean
    bool used;               // false: overexposed or black, so nothing is learned from it
    double delta_e_before;   // CIEDE2000 by exposure alone,
    double delta_e_balance;  // by white balance,
    double delta_e;          // and by the matrix
};

// A target as it was found, and what follows from it. Thread-safety: plain data.
struct relume_chart {
    int photograph;       // which of those given
    double corner[4][2];  // outer corners of dark skin, bluish green, black and white, pixels
    struct relume_chart_patch patch[RELUME_CHART_PATCHES];
    int used;            // patches that count
    float matrix[9];     // row by row: photographed linear light -> linear sRGB; a grey keeps its
                         // luminance (BT.709)
    float white[3];      // gains for red, green and blue of white balance alone, likewise
    double exposure;     // a patch shows its reflectance when multiplied by this
    double uneven;       // how much the light on the target differs: largest / smallest - 1
    double before[2];    // CIEDE2000 over the patches used, mean and largest: exposure alone,
    double balanced[2];  // white balance,
    double after[2];     // the matrix
};

#ifdef __cplusplus
}
#endif
#endif
