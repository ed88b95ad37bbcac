// neighbours.h - photographs as those under similar lights predict them
#ifndef ACQUIRE_NEIGHBOURS_H
#define ACQUIRE_NEIGHBOURS_H

#include "core/math/vec.h"

#include <relume/base.h>

// Interpolation over the directions of lights, which are borrowed.
struct neighbours {
    int n;
    const vec3 *direction;  // [n], unit
    double *inverse;        // [n + 3][n + 3], of the system of the interpolation
    double *kernel;         // [n], of the light that is asked for
};

// RELUME_EUNFIT where the directions do not determine a prediction (fewer than 5, all in a line),
// RELUME_ENOMEM.
relume_status neighbours_create(struct neighbours *out, const vec3 *direction, int n);
void neighbours_destroy(struct neighbours *set);

// weight[n] of the photographs that predict what photograph `left_out` would show under light
// `d`; its own is 0. Returns the predicted standard deviation, in units of that of one radian.
double neighbours_weights(const struct neighbours *set, int left_out, vec3 d, double *weight);
// The same without leaving one out. Weights without photograph `i` are w - q w[i] / q[i], q being
// row i of the inverse.
void neighbours_all_weights(const struct neighbours *set, vec3 d, double *weight);
const double *neighbours_row(const struct neighbours *set, int i);

#endif
