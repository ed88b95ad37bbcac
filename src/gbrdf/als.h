// als.h - the parameters of a reflectance, by alternating least squares in the log metric
#ifndef GBRDF_ALS_H
#define GBRDF_ALS_H

#include "gbrdf/flat.h"

// One pair of directions at one texel, in its frame.
struct als_sample {
    float value[3];  // Lr / Li, of a white matte surface n.l / pi
    float cosine;    // k1.n
    float share;     // k1.n / D
    float grazing;   // (1 - k1.h)^5
    float place[2];  // of h, from the middle of the first cell
};
// Distributions and values are of one channel, of luminance, or of three.
struct als_form {
    int side, channels;
    int stride;    // every so manieth pair
    double light;  // that values are divided by
};
// Fill out[views * lights] from a texel's values [view][light][3]; how many are of use: seen, lit
// and not too flat. `turn` is the rotation of its frame.
int als_gather(struct als_sample *out, const struct flat *flat, size_t texel, double turn,
               const float *values, const struct als_form *form);

struct als_texel {
    double diffuse[3], r0;
};

// The best parameters of a texel beside q[side^2][channels]. Returns by what q should be multiplied
// to suit this texel best, and where `fixed` what is best if it is not.
double als_fit_texel(struct als_texel *t, const float *q, const struct als_form *form,
                     const struct als_sample *sample, int n, bool fixed);

// Sums for a better q beside some texels.
struct als_sums {
    double above[NDF_SIDE * NDF_SIDE][3], below[NDF_SIDE * NDF_SIDE][3];
};
void als_add(struct als_sums *sums, const struct als_texel *t, const float *q,
             const struct als_form *form, const struct als_sample *sample, int n);
// q by them; cells without samples are filled. Kept below what energy allows beside `diffuse`.
void als_solve(float *q, const struct als_sums *sums, const struct als_form *form,
               const double diffuse[3]);

// Both in turn for a single texel, from a start of their own.
void als_fit_alone(struct als_texel *t, float *q, struct als_sums *scratch,
                   const struct als_sample *sample, int n, const struct als_form *form, int rounds);

#endif
