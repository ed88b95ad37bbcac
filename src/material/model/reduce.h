// reduce.h - few numbers for each texel: the leading singular vectors of all values, texels by
// pairs of directions and colours
#ifndef BTF_MODEL_REDUCE_H
#define BTF_MODEL_REDUCE_H

#include "material/model/model.h"

struct reduced {
    size_t texels, values;  // values of a texel: views * lights * 3
    int count;
    float *score;  // [texel][count]
    float *basis;  // [count][values], orthonormal: a texel is about the sum of score * basis
};
// At most `count`, fewer when there are fewer texels. RELUME_ENOMEM, RELUME_ECANCEL.
relume_status reduce_make(struct reduced *out, const struct fitting *f, int count);
void reduce_free(struct reduced *r);

// Texels in clusters of alike ones (Lloyd 1982), which[texel] in [0, clusters). RELUME_ENOMEM.
relume_status reduce_cluster(const struct reduced *r, const struct fitting *f, int clusters,
                             int *which);

// The texels of each cluster one after the other; cluster c has those from first[c] to
// first[c + 1]. RELUME_ENOMEM; the caller frees both.
struct members {
    size_t *texel;  // [texels]
    size_t *first;  // [clusters + 1]
};
relume_status members_make(struct members *out, const int *which, size_t texels, int clusters);
void members_free(struct members *m);

// Cluster the texels of f->btf into f->out->clusters, keep the cluster of each in array `which` of
// f->out and call `fit` for each cluster with its mean values [view][light][3], on several cores;
// false: no memory. RELUME_ENOMEM, RELUME_ECANCEL.
relume_status clusters_fit(const struct fitting *f, int which,
                           bool (*fit)(const void *context, size_t cluster, const float *values),
                           const void *context);

#endif
