// footprint.h - where to look for what a pixel covers, so that a smaller picture is a mean
//
// A pixel that covers r texels along a side takes n = ceil(r) bilinear samples in a row whose
// places have the variance of r texels side by side, (r^2 - 1) / 12: of a whole r that is the mean
// of r texels. Below r = 2 the samples move together, until from 1.25 on the pixel's centre is all
// that is looked at: a picture in about its own size costs nothing more, and at no size or zoom
// does it jump from sharp to soft. Shaders: viewer/shaders/shared/footprint.glsl.
#ifndef IMAGE_FOOTPRINT_H
#define IMAGE_FOOTPRINT_H

#include <math.h>

// Sizes are computed: this much more than a whole number of texels is that number.
#define FOOTPRINT_SLACK 1e-4
// Of so many texels a pixel is not said to be a mean yet.
#define FOOTPRINT_ONE 1.25
// Where a pixel may cover any number of texels, it takes at most this many samples a side.
enum { FOOTPRINT_MOST = 64 };

struct footprint {
    int count;
    double step;  // from sample to sample, of a pixel
};

static inline struct footprint footprint_of(double texels, int most)
{
    if (!(texels > FOOTPRINT_ONE))
        return (struct footprint){1, 0.0};
    const double r = texels < 2.0 ? 1.0 + (texels - FOOTPRINT_ONE) / (2.0 - FOOTPRINT_ONE) : texels;
    const double whole = fmin(fmax(ceil(r - FOOTPRINT_SLACK), 2.0), most);
    const double step = sqrt((r * r - 1.0) / (whole * whole - 1.0));
    return (struct footprint){(int)whole, step / texels};
}

// Of sample i, from the pixel's centre.
static inline double footprint_place(struct footprint f, int i)
{
    return (i - 0.5 * (f.count - 1)) * f.step;
}

// Catmull and Rom's weights of the four texels around a place `part` beyond the second.
static inline void footprint_cubic(double weight[4], double part)
{
    const double t = part;
    weight[0] = t * (-0.5 + t * (1.0 - 0.5 * t));
    weight[1] = 1.0 + t * t * (-2.5 + 1.5 * t);
    weight[2] = t * (0.5 + t * (2.0 - 1.5 * t));
    weight[3] = t * t * (-0.5 + 0.5 * t);
}

#endif
