// chart.h - the steps from a photograph to the places and colours of a target's patches
#ifndef CHART_CHART_H
#define CHART_CHART_H

#include <relume/capture/chart.h>

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
