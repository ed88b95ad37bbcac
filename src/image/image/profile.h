// profile.h - embedded ICC profiles as three curves and a matrix
#ifndef IMAGE_PROFILE_H
#define IMAGE_PROFILE_H

#include <stdbool.h>
#include <stddef.h>

enum { PROFILE_STEPS = 1024 };

struct profile {
    float curve[3][PROFILE_STEPS + 1];  // code i / PROFILE_STEPS -> linear light
    float to_srgb[9];                   // that light -> linear sRGB
};

// False when it is no RGB profile of curves and a matrix.
bool profile_read(struct profile *out, const void *icc, size_t size);
// The profile of sRGB as a file holds it, to be freed; NULL when memory is short. Equal bytes at
// all times.
void *profile_srgb(size_t *size);
float profile_decode(const struct profile *profile, int channel, float code);

#endif
