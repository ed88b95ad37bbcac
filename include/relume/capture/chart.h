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

// How a target is looked for and judged. Borrowed during the call.
struct relume_chart_params {
    size_t struct_size;  // filled by the macro (base.h)
    const struct relume_log *log;
    const struct relume_limits *limits;
    struct relume_transfer transfer;  // of photographs, overrides what the files say
    // Outer corners of the four corner patches, pixels, in order around the target, whichever comes
    // first; NULL: the target is found.
    const double (*corner)[2];
    // What the patches are by measurement: L*, a*, b* (D50, 2 degrees); NULL: the published values
    // of charts made since November 2014.
    const double (*reference)[3];
    bool ends_at_1;  // relume_chart_measure: the photograph is clipped at 1
};
#define relume_chart_params(...)                                                                   \
    (&(const struct relume_chart_params){RELUME_SIZED(relume_chart_params), __VA_ARGS__})

// Find the target in a linear photograph of three channels, or take params->corner, and fit the
// matrix. `name` is for sentences. RELUME_EUNFIT when no target is found or what lies between the
// corners is none, RELUME_EINVAL for other channels, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_chart_measure(struct relume_chart *out,
                                                 const struct relume_image *photograph,
                                                 const char *name,
                                                 const struct relume_chart_params *params);
// The same of the photograph among `paths` whose target gives the smallest differences; of many,
// eight spread over all are looked at. An input status, RELUME_EUNFIT, RELUME_ENOMEM.
RELUME_RESULT relume_status relume_chart_load(struct relume_chart *out, const char *const *paths,
                                              int n, const struct relume_chart_params *params);
// Linear sRGB of the 24 patches by L*, a*, b* (D50; NULL: published), with Bradford's adaptation;
// some lie outside of 0 to 1.
RELUME_API void relume_chart_colours(double rgb[RELUME_CHART_PATCHES][3],
                                     const double (*reference)[3]);
// Read 24 lines of L*, a* and b*, the numbers last in each line ('#' starts a comment): what a
// spectrophotometer says of one's own chart. RELUME_EFORMAT, an input status.
RELUME_RESULT relume_status relume_chart_reference_load(double reference[RELUME_CHART_PATCHES][3],
                                                        const char *path,
                                                        const struct relume_log *log);

// pixel = matrix pixel, as relume_primaries_apply; where all three channels of a clipped photograph
// are at 1 the result is grey, for nothing is known of the colour there.
RELUME_API void relume_chart_apply(struct relume_image *image, const float matrix[9],
                                   bool ends_at_1);

#ifdef __cplusplus
}
#endif
#endif
