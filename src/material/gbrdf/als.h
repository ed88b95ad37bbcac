// als.h - the parameters of a reflectance, by alternating least squares in the log metric
#ifndef GBRDF_ALS_H
#define GBRDF_ALS_H

#include "material/gbrdf/flat.h"

// Pairs of directions at one texel, in its frame, by eights, so that the compiler can take them at
// once. What is left of the last eight is zero, which tells nothing.
enum { ALS_LANES = 8 };
struct als_block {
    float value[3][ALS_LANES];   // Lr / Li, of a white matte surface n.l / pi
    float cosine[ALS_LANES];     // k1.n
    float share[ALS_LANES];      // k1.n / D
    float trust[ALS_LANES];      // how much its squared error counts
    float grazing[ALS_LANES];    // (1 - k1.h)^5
    float corner[4][ALS_LANES];  // shares of the cells around h
    float shine[3][ALS_LANES];   // als_look: q there, times the share
    uint16_t cell[ALS_LANES];    // the first of these; then right of it, below, and both
};
// Of one texel.
struct als_samples {
    struct als_block *block;  // [als_blocks(views * lights)], the caller's
    int count;                // of pairs
    float least;              // darker values count as if they had this one
};
static inline size_t als_blocks(size_t pairs)
{
    return (pairs + ALS_LANES - 1) / ALS_LANES;
}

// Distributions and values are of one channel, of luminance, or of three.
struct als_form {
    int side, channels;
    int stride;    // every so manieth pair
    double light;  // that values are divided by
};
// Fill out->block from a texel's values [view][light][3]: with what is seen, lit and not too flat.
// `turn` is the rotation of its frame.
void als_gather(struct als_samples *out, const struct flat *flat, size_t texel, double turn,
                const float *values, const struct als_form *form);

struct als_texel {
    double diffuse[3], r0;
};

// Take what q[side^2][channels] is at each pair.
void als_look(struct als_samples *samples, const float *q, const struct als_form *form);
// The best parameters of a texel beside `scale` times the q that was looked at. Returns by what
// that should be multiplied to suit this texel best, and where `fixed` what is best if it is not.
double als_fit_texel(struct als_texel *t, float scale, const struct als_form *form,
                     const struct als_samples *samples, bool fixed);

// Sums for a better q beside some texels.
struct als_sums {
    double above[NDF_SIDE * NDF_SIDE][3], below[NDF_SIDE * NDF_SIDE][3];
};
void als_add(struct als_sums *sums, const struct als_texel *t, float scale,
             const struct als_form *form, const struct als_samples *samples);
// q by them, which it uses up: one distribution times a share of each colour; cells without samples
// are filled. Kept below what energy allows beside `diffuse`.
void als_solve(float *q, struct als_sums *sums, const struct als_form *form,
               const double diffuse[3]);

// Both in turn for a single texel, from a start of their own.
void als_fit_alone(struct als_texel *t, float *q, struct als_sums *scratch,
                   struct als_samples *samples, const struct als_form *form, int rounds);

#endif
