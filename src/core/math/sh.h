// sh.h - real spherical harmonics (Wong 1998, appendix A)
#ifndef MATH_SH_H
#define MATH_SH_H

#include <relume/base.h>

enum { SH_MAX_DEGREE = 15 };

// Y_lm of the unit vector `d` for l = 0..degree, m = -l..l at values[l (l + 1) + m]; orthonormal
// over the sphere. theta is measured from the third axis, phi = atan2(y, x).
void sh_evaluate(int degree, struct relume_vec3 d, double *values);

// N_lm = sqrt((2l+1)/(2 pi) (l-m)!/(l+m)!), 0 <= m <= l
double sh_normalisation(int l, int m);

#endif
