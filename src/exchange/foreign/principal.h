// principal.h - principal components of numbers x whose errors count by a metric
//
// With the metric G, an error e of x weighs e' G e: the components of x are those of G^1/2 x, and
// one unit of any of them is one unit of error.
#ifndef FOREIGN_PRINCIPAL_H
#define FOREIGN_PRINCIPAL_H

#include <relume/base.h>

struct principal {
    int count;
    double total;            // variance of all
    double *value;           // [count] variances, the largest first
    double *forward, *back;  // [count][n]: c = forward x, x = back^T c
};

// Of n numbers with that covariance [n][n] the `count` largest; `metric` [n][n] is destroyed.
// RELUME_ENOMEM.
relume_status principal_find(struct principal *out, double *metric, const double *covariance, int n,
                             int count);
void principal_free(struct principal *c);

#endif
