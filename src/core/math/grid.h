// grid.h - a picture of which the differences between neighbours are roughly known
//
// The picture z that minimises
//     sum w (z_b - z_a - d)^2 + screen sum z^2
// over all pairs of neighbours, each with a weight of its own: the linear system of a weighted
// Laplacian. Conjugate gradients, preconditioned by a cycle of multigrid in which cells of 2 x 2
// merge (unsmoothed aggregation with overcorrection, Braess 1995) and values are relaxed in red and
// black before and after. The same bits for any number of threads.
#ifndef MATH_GRID_H
#define MATH_GRID_H

#include <relume/base.h>

// All [height][width], zero at first. The caller sets the pairs before every search; `z` is where
// it begins, and what it has found. The last column of `right` and the last row of `down` stay 0.
struct grid {
    int width, height, threads;
    float screen;
    float *right, *down;    // w of the pairs with the next column, with the next row
    float *across, *below;  // w d of the same; spoilt by the search
    float *z;
    struct grid_work *work;
};

// RELUME_ENOMEM; `out` may be destroyed in any case.
relume_status grid_create(struct grid *out, int width, int height, float screen, int threads);
void grid_destroy(struct grid *grid);

// At most `steps` of the conjugate gradients, until the error has fallen to `share` of what it was
// at the start of this call, or of what it was for z = 0.
void grid_solve(struct grid *grid, int steps, double share);

#endif
