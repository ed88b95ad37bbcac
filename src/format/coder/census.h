// census.h - pixels and images that carry no information: black, or clipped
#ifndef CODER_CENSUS_H
#define CODER_CENSUS_H

#include "format/coder/basis.h"

// Counted by several workers at once, each for itself.
struct census {
    int lights, workers;
    float (*white)[3];            // [lights], in the coefficients' domain; infinite for floats
    struct relume_census *count;  // [workers]; black_images is not used
    bool *lit;                    // [workers][lights]
};
relume_status census_create(struct census *c, const relume_capture *capture,
                            struct relume_transfer display, int workers);
void census_destroy(struct census *c);
// Some pixels: planes[channel][light][n]. `mask` may be NULL.
void census_add(struct census *c, int worker, const float *planes, size_t n, const float *mask);
struct relume_census census_result(const struct census *c);
// Whether a sample of a light is above 0.
bool census_is_lit(const struct census *c, int light);

#endif
