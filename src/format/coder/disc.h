// disc.h - cosines on the stereographic discs of the sphere (Wong 1998, 9.1.2)
//
// A hemisphere maps to the disc of radius 1/2 in the unit square (Eq. 9.3, 9.4), the other one
// likewise from its own pole. The K functions are the products cos(pi u x) cos(pi v y) of lowest
// u + v (zonal selection), orthonormal over the square; with two discs, half of them each.
#ifndef CODER_DISC_H
#define CODER_DISC_H

#include "format/coder/basis.h"

struct disc_point {
    double x, y;
    bool lower;  // on the disc of the hemisphere away from the pole
};
struct disc_point disc_from_direction(vec3 d);
// Points of the square outside the disc give the border at the same azimuth.
vec3 disc_to_direction(struct disc_point p);

// u and v of the k-th function of one disc.
struct disc_wave {
    int u, v;
};
struct disc_wave disc_wave_of(int k);
// How many of the K functions belong to the upper disc; all when the coder is hemispherical.
int disc_upper_count(const relume_coder *coder);
double disc_cosine(struct disc_wave w, struct disc_point p);

// Shared by the two bases dct and dct-resampled.
bool disc_has_count(int count);
int disc_fit_count(int want, int lights);
void disc_evaluate(const relume_coder *coder, struct relume_vec3 light, double *values);
void disc_release(relume_coder *coder);

#endif
