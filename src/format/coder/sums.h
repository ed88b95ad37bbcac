// sums.h - what learning adds up of samples: once for all lights, of which a coder may have some
#ifndef CODER_SUMS_H
#define CODER_SUMS_H

#include <relume/format/coder.h>

// Arrays are NULL until they are known.
struct relume_sample_sums {
    int lights;
    double *gram;        // [lights][lights]: mean over pixels and channels
    double *mean;        // [3 lights], as [channel][light]
    double *covariance;  // [3 lights][3 lights]
};

// Add up what `s` does not know yet; mean and covariance where `learned`. RELUME_ENOMEM.
relume_status sample_sums_make(struct relume_sample_sums *s, const struct relume_samples *samples,
                               bool learned, int threads);
// Those of the lights light[n]. RELUME_ENOMEM.
relume_status sample_sums_pick(struct relume_sample_sums *out, const struct relume_sample_sums *all,
                               const int *light, int n);
void sample_sums_free(struct relume_sample_sums *s);

// The Gram matrix [lights][lights] of the images, mean over pixels and channels.
relume_status samples_gram(double *gram, const struct relume_samples *s, int threads);
// mean[3 lights] and covariance[3 lights][3 lights] of pixels as [channel][light].
relume_status samples_covariance(double *mean, double *covariance, const struct relume_samples *s,
                                 int threads);

#endif
