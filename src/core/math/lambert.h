// lambert.h - which way a surface faces, from its brightness under several lights
//
// The value of a Lambertian pixel under a light of 1 from L is g.L with g = albedo x normal, as
// long as the light is in front (Woodham 1980). Samples are sorted by brightness, the ends are cut
// off, and g is found by iteratively reweighted least squares with the weights 1 / (1 + (r / c)^2)
// (Holland and Welsch 1977). Where samples are few the ends come back then and are weighed as well:
// which of them is cut off changes from pixel to pixel, and g jumped there.
#ifndef MATH_LAMBERT_H
#define MATH_LAMBERT_H

#include "core/math/vec.h"

// Cosines below are no evidence.
#define LAMBERT_GRAZING 0.05

struct lambert_sample {
    float value;
    float weight;  // 1 on entry; what the sample weighs in the fit afterwards
    int light;     // its place in `direction`
};

// Whether directions determine all three components of g.
bool lambert_spans(const vec3 *direction, int n);

// Fit `n` samples, which change their order; the `*n` that count afterwards begin at the returned
// place, NULL where there is nothing to fit: too few, or black.
struct lambert_sample *lambert_fit(vec3 *g, const vec3 *direction, struct lambert_sample *s, int *n,
                                   bool plain);

#endif
