// plan_view.h - what a viewer shows of a source's numbers: the ground that every plan stands on
//
// Directions: the captured lights, and a spiral over the hemisphere, half of the weight each. A
// viewer's functions f approximate the picture A(l) x by f(l) N x, N by least squares with a small
// pull towards the values at the nodes.
#ifndef FOREIGN_PLAN_VIEW_H
#define FOREIGN_PLAN_VIEW_H

#include "exchange/foreign/plan.h"

struct plan_view {
    int directions, functions, numbers;
    struct relume_vec3 *direction;
    double *share;              // [directions], sums to 1
    double *f;                  // [directions][functions]
    double *a;                  // [directions][3][P + 1]: what the file shows
    double *nodes;              // [functions][3][P + 1]
    double *shown;              // [directions][3][P + 1]: what the viewer shows
    double *mean, *covariance;  // [P], [P][P] of the numbers over the picture
};

// Allocates the plan's arrays too, from its form, functions and planes. RELUME_ENOMEM, and what
// source_statistics returns.
relume_status plan_view_open(struct plan_view *v, struct plan *p, const struct source *s,
                             int threads);
void plan_view_close(struct plan_view *v);
// The mean over pixels and directions of |(A - A') x|^2, summed over the channels.
relume_status plan_view_loss(const struct plan_view *v, double *lost);

#endif
