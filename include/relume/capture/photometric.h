// photometric.h - surface normals, albedo and height from the photographs of a capture
//
// Photometric stereo on the captured images themselves, each pixel with its own directions where
// lights are near. First as if all were matte (Woodham 1980): the darkest and brightest samples of
// a pixel are left out, the others weighed by how well they fit (Cauchy weights, Holland and Welsch
// 1977). With six lights or more, and planar views, what the object is made of is found from some
// hundred of its pixels, and each pixel's normal with it (Hui and Sankaranarayanan 2017), so that
// gloss and metal do not mislead, but tell.
#ifndef RELUME_PHOTOMETRIC_H
#define RELUME_PHOTOMETRIC_H

#include <relume/base.h>
#include <relume/capture.h>
#include <relume/image.h>

#ifdef __cplusplus
extern "C" {
#endif

// All of the size of the view. Thread-safety: plain data.
struct relume_photometric {
    struct relume_image normal;  // three channels: unit vectors, world; zero where nothing is known
    struct relume_image albedo;  // three: linear value under a light of 1 from the normal
    struct relume_image error;   // one: RMS of what a matte fit misses over the samples that it
                                 // kept, as share of the albedo
    double residual;             // the median of `error` over the pixels that are known
    double *light_residual;      // [lights]: median over pixels of |miss| / albedo, lit ones
    double *light_gain;          // [lights]: how many times as bright as expected, median likewise
    double *mended_residual;     // [lights]: light_residual where light_gain is divided out
    int lights;
    struct relume_image confidence;  // one: 0 (a guess) to 1 (to a fraction of a degree); by how
                                     // narrowly the samples determine the normal
};

#ifdef __cplusplus
}
#endif
#endif
