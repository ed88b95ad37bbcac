// harmonics.h - what the bases of spherical and of hemispherical harmonics share
#ifndef CODER_HARMONICS_H
#define CODER_HARMONICS_H

#include "format/coder/basis.h"

// The degree whose (degree + 1)^2 functions are `count`, or -1: no square.
int harmonics_degree(int count);

// The most functions of degree `most_degree` or less that are not above `want` nor the lights; by
// itself (want 0) half as many as lights, at most `plenty`: more fit the noise.
int harmonics_fit_count(int want, int lights, int plenty, int most_degree);

// Least squares with the Laplacian's eigenvalue squared for roughness: bending, which noise has
// and reflectance has little of.
relume_status harmonics_prepare(relume_coder *coder, const struct relume_log *log);

#endif
