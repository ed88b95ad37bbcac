// hsh.c - H_lm = sqrt(2) N_lm P_l|m|(2 cos theta - 1) { cos m phi, 1 / sqrt 2, sin |m| phi }
//         N_lm as for the spherical harmonics
#include "core/math/hsh.h"
#include "core/math/sh.h"

#include <assert.h>

void hsh_evaluate(int degree, vec3 d, double *values)
{
    assert(degree <= HSH_MAX_DEGREE);
    const double cosine = fmax(d.z, sin(0.01)), x = 2.0 * cosine - 1.0;
    const double sine = sqrt(fmax(1.0 - x * x, 0.0)), phi = atan2(d.y, d.x);
    double p_mm = 1.0;  // without the sign (-1)^m of Condon and Shortley
    for (int m = 0; m <= degree; m++) {
        double before = 0.0, p = p_mm;
        for (int l = m; l <= degree; l++) {
            const double n = sh_normalisation(l, m) * p * (m * (m - 1) / 2 % 2 ? -1.0 : 1.0);
            if (m == 0) {
                values[l * (l + 1)] = n;
            } else {
                values[l * (l + 1) - m] = M_SQRT2 * n * cos(m * phi);
                values[l * (l + 1) + m] = M_SQRT2 * n * sin(m * phi);
            }
            const double next = (x * (2 * l + 1) * p - (l + m) * before) / (l + 1 - m);
            before = p;
            p = next;
        }
        p_mm *= (2 * m + 1) * sine;
    }
}
