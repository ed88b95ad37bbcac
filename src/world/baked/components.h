// components.h - local principal components of long vectors that are made when they are asked for
#ifndef BAKED_COMPONENTS_H
#define BAKED_COMPONENTS_H

#include <relume/base.h>

// y ~ mean[c] + sum_i a_i e_i[c]: clusters by k-means, components of each (Meseth 2008, 10.1.2;
// Mueller, Meseth, Klein 2003). Learned from `taught` vectors that are
// evenly spread.
struct local_components {
    int clusters, components;  // of each, which some of may be zero
    size_t length;             // of a vector
    float *vector;             // [clusters][1 + components][length]: mean, then unit components
};
// From rows[taught][stride] of which each begins with `length` numbers. `vector` is the caller's.
// RELUME_ENOMEM.
relume_status components_learn(const struct local_components *out, const float *rows, size_t taught,
                               size_t stride, int threads);

// The cluster whose mean is nearest to a vector. Lowest number where several are.
int components_nearest(const struct local_components *c, const float *y);
// The one of some nearest that says it best (Kambhatla and Leen 1997), and its weights there; the
// square of what is left, which lies in left[length].
int components_best(float *weights, double *square, const struct local_components *c,
                    const float *y, float *left);

#endif
