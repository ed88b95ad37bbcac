// sh.c - Wong 1998, appendix A:
//   Y_lm = N_lm P_lm(cos theta) cos(m phi)     m > 0
//          N_l0 P_l0 / sqrt 2                  m = 0
//          N_l|m| P_l|m| sin(|m| phi)          m < 0
//   N_lm = sqrt((2l+1)/(2 pi) (l-|m|)!/(l+|m|)!)
// P_lm by the recurrences of the appendix, with sin^m theta moved from P_mm into the azimuth:
// sin^m theta cos(m phi) and sin^m theta sin(m phi) are polynomials in x and y, so that the poles
// need no special case.
#include "core/math/sh.h"

#include <assert.h>
#include <math.h>

double sh_normalisation(int l, int m)
{
    double ratio = 1.0;  // (l-m)! / (l+m)!
    for (int i = l - m + 1; i <= l + m; i++)
        ratio /= i;
    return sqrt((2 * l + 1) / (2.0 * M_PI) * ratio);
}

void sh_evaluate(int degree, struct relume_vec3 d, double *values)
{
    assert(degree <= SH_MAX_DEGREE);
    double cosine = 1.0, sine = 0.0;  // sin^m theta cos / sin (m phi)
    double p_mm = 1.0;                // P_mm / sin^m theta
    for (int m = 0; m <= degree; m++) {
        double before = 0.0, p = p_mm;
        for (int l = m; l <= degree; l++) {
            const double n = sh_normalisation(l, m) * p;
            if (m == 0) {
                values[l * (l + 1)] = n / M_SQRT2;
            } else {
                values[l * (l + 1) + m] = n * cosine;
                values[l * (l + 1) - m] = n * sine;
            }
            const double next = (d.z * (2 * l + 1) * p - (l + m) * before) / (l + 1 - m);
            before = p;
            p = next;
        }
        p_mm *= 1 - 2 * (m + 1);
        const double c = cosine * d.x - sine * d.y;
        sine = cosine * d.y + sine * d.x;
        cosine = c;
    }
}
