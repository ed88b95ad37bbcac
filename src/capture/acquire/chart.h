// chart.h - the steps from a photograph to the places and colours of a target's patches
#ifndef CHART_CHART_H
#define CHART_CHART_H

#include <relume/capture/chart.h>

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
relume_status relume_chart_measure(struct relume_chart *out, const struct relume_image *photograph,
                                   const char *name, const struct relume_chart_params *params);
// The same of the photograph among `paths` whose target gives the smallest differences; of many,
// eight spread over all are looked at. An input status, RELUME_EUNFIT, RELUME_ENOMEM.
relume_status relume_chart_load(struct relume_chart *out, const char *const *paths, int n,
                                const struct relume_chart_params *params);
// Linear sRGB of the 24 patches by L*, a*, b* (D50; NULL: published), with Bradford's adaptation;
// some lie outside of 0 to 1.
void relume_chart_colours(double rgb[RELUME_CHART_PATCHES][3], const double (*reference)[3]);
// Read 24 lines of L*, a* and b*, the numbers last in each line ('#' starts a comment): what a
// spectrophotometer says of one's own chart. RELUME_EFORMAT, an input status.
relume_status relume_chart_reference_load(double reference[RELUME_CHART_PATCHES][3],
                                          const char *path, const struct relume_log *log);

// pixel = matrix pixel, as relume_primaries_apply; where all three channels of a clipped photograph
// are at 1 the result is grey, for nothing is known of the colour there.
void relume_chart_apply(struct relume_image *image, const float matrix[9], bool ends_at_1);

enum {
    CHART_COLUMNS = RELUME_CHART_COLUMNS,
    CHART_ROWS = RELUME_CHART_ROWS,
    CHART_PATCHES = RELUME_CHART_PATCHES
};

// Cells are one unit apart, patch i at (i % 6, i / 6); a patch reaches so far from its middle.
#define CHART_HALF 0.44
// Mean CIEDE2000 of what passes for a target.
#define CHART_LIKE 7.0

// A plane seen in perspective: (x, y) of the plane -> pixels, row by row, h[8] = 1.
struct homography {
    double h[9];
};
// Least squares over n >= 4 pairs; false when they do not determine it.
bool homography_fit(struct homography *out, const double (*plane)[2], const double (*pixel)[2],
                    int n);
void homography_apply(double out[2], const struct homography *h, double x, double y);

// An even region of a picture.
struct blob {
    double x, y;  // its middle, pixels
    double area;
};
// Even regions of about the shape of a parallelogram, where neighbours differ by less than `step`
// of the cube root of light. The caller frees `*out`. RELUME_ENOMEM.
relume_status blobs_find(struct blob **out, int *n, const struct relume_image *image, float step);

// Even regions that lie as the patches of a target do: for each arrangement `seen` is asked, which
// says by the colours whether it is one. RELUME_ENOMEM.
relume_status lattice_find(const struct blob *blob, int n,
                           bool (*seen)(void *context, const struct homography *h), void *context);

// Fit everything but places to patch[].found and .used. False when that cannot be.
bool chart_fit(struct relume_chart *t, const double (*reference)[3], bool carefully);

// L*, a*, b* (D65) of linear sRGB.
void chart_lab(double lab[3], const double rgb[3]);

#endif
