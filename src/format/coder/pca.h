// pca.h - the components of a learned basis, in the metric of the relit hemisphere (pca.c)
#ifndef CODER_PCA_H
#define CODER_PCA_H

#include "format/coder/basis.h"

// A pixel's 3 N samples t, as [channel][light], are written as t = mean + sum_k c_k function_k with
// c_k = analysis_k . (t - mean).
struct components {
    int count, lights;
    double *mean;      // [3 N]
    double *analysis;  // [count][3 N]
    double *function;  // [count][3 N]
};
// From the samples of `coder`, whose interpolant is ready.
relume_status components_find(struct components *out, const relume_coder *coder);
void components_destroy(struct components *c);

#endif
