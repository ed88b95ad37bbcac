// cluster.h - texels of one distribution, whichever way it is turned
#ifndef GBRDF_CLUSTER_H
#define GBRDF_CLUSTER_H

#include "material/gbrdf/ndf.h"

// A distribution by colatitude and longitude: square roots of shares, whose squares add up to 1, so
// that distances are Hellinger's. A turn about the normal is a shift along the second index.
enum { POLAR_RINGS = 8, POLAR_AROUND = 32, POLAR_VALUES = POLAR_RINGS * POLAR_AROUND };

// From q[side^2] of luminance.
void polar_from(float polar[POLAR_VALUES], const float *q, int side);
// How far `polar` has to be shifted forwards to lie best on `centre`, in parts of a turn of one
// around [0, POLAR_AROUND), and how far it is from it then. Its rotation is as much.
double polar_align(const float *polar, const float *centre, double *shift);

struct clusters {
    int count;
    double separation;  // spread over distance: small where materials are distinct
    uint8_t *label;     // [texels]
    float *rotation;    // [texels], radians
};
// Of width x height texels with polar[texel][POLAR_VALUES], the best number of at most `most`, or
// that number where `exact`, less those that end without a texel. RELUME_ENOMEM.
relume_status clusters_find(struct clusters *out, const float *polar, int width, int height,
                            int most, bool exact, uint64_t seed, int threads);
void clusters_free(struct clusters *c);

#endif
