// nearest.h - the nearest of many code vectors, exactly
#ifndef CODEBOOK_NEAREST_H
#define CODEBOOK_NEAREST_H

#include "core/kernel/kernels.h"

// Code vectors packed for the search. Thread-safety: searching is safe.
struct nearest {
    const struct nearest_kernels *kernels;
    int codes, dim, tiles;
    float *center;          // [dim]
    float scale;            // packed = (code - center) * scale, the largest about 1
    float *packed, *exact;  // [tiles][dim][TILE]
    float *half;            // [tiles][TILE]: half the squared length, +inf behind the last code
};

// RELUME_ENOMEM. Codes are set apart.
relume_status nearest_create(struct nearest *out, int codes, int dim, unsigned cpu_off);
void nearest_destroy(struct nearest *n);
void nearest_set(struct nearest *n, const float *codes);

// For the vectors which[0 .. count) of vectors[][dim]: index[i], the lowest code of the smallest
// squared distance, and that distance; apart[i] is no more than the distance (not squared) to any
// other code. `scratch` has nearest_scratch() floats.
void nearest_find(const struct nearest *n, const float *vectors, const uint32_t *which,
                  size_t count, uint16_t *index, double *distance, float *apart, float *scratch);
size_t nearest_scratch(const struct nearest *n);

// In double precision, from the first component to the last.
static inline double squared_distance(const float *a, const float *b, size_t dim)
{
    double sum = 0.0;
    for (size_t i = 0; i < dim; i++) {
        const double d = (double)a[i] - (double)b[i];
        sum += d * d;
    }
    return sum;
}

#endif
