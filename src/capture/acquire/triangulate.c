// triangulate.c - the place of a lamp from several lines that point to it
//
// The point with the least sum of squared distances solves sum (1 - d d') x = sum (1 - d d') o; its
// covariance is the inverse of that matrix times the variance of the distances.
#include <relume/capture/ball.h>

#include "capture/acquire/ball.h"
#include "core/math/lsq.h"
#include "core/math/vec.h"

static const double LEAST_ANGLE = 2e-3;  // radians between the lines, RMS

relume_status relume_light_triangulate(struct relume_vec3 *position, double *sigma,
                                       const struct relume_vec3 *origin,
                                       const struct relume_vec3 *direction, int n)
{
    double m[9] = {0.0}, b[3] = {0.0}, values[3], copy[9];
    *position = vec3_of(0.0, 0.0, 0.0);
    *sigma = 0.0;
    for (int i = 0; i < n; i++) {
        const double d[3] = {direction[i].x, direction[i].y, direction[i].z};
        const double o[3] = {origin[i].x, origin[i].y, origin[i].z};
        for (int j = 0; j < 9; j++) {
            const double p = (j / 3 == j % 3) - d[j / 3] * d[j % 3];
            m[j] += p;
            b[j / 3] += p * o[j % 3];
        }
    }
    for (int j = 0; j < 9; j++)
        copy[j] = m[j];
    if (n < 2 || !lsq_eigenvalues(copy, 3, values) || values[0] < n * LEAST_ANGLE * LEAST_ANGLE ||
        lsq_invert(m, 3))
        return RELUME_EUNFIT;
    *position =
        vec3_of(m[0] * b[0] + m[1] * b[1] + m[2] * b[2], m[3] * b[0] + m[4] * b[1] + m[5] * b[2],
                m[6] * b[0] + m[7] * b[1] + m[8] * b[2]);
    double squares = 0.0;
    for (int i = 0; i < n; i++) {
        const vec3 to = vec3_sub(*position, origin[i]);
        const double along = vec3_dot(to, direction[i]);
        if (along <= 0.0)  // the lines cross behind the balls
            return RELUME_EUNFIT;
        squares += vec3_dot(to, to) - along * along;
    }
    const double freedom = n > 1 ? 2.0 * n - 3.0 : 1.0;
    *sigma = sqrt(squares / freedom * (m[0] + m[4] + m[8]));
    return RELUME_OK;
}
