// hsh.h - hemispherical harmonics (Gautron et al. 2004)
#ifndef MATH_HSH_H
#define MATH_HSH_H

#include "core/math/vec.h"

enum { HSH_MAX_DEGREE = 4 };

// The (degree + 1)^2 values at unit direction d, z towards the pole, in the order and with the
// signs of .rti files: per degree m = l .. -l, cosines before sines, sign (-1)^(m (m - 1) / 2).
// Below 0.01 radians above the horizon, where the functions turn infinitely fast, that elevation
// counts.
void hsh_evaluate(int degree, vec3 d, double *values);

#endif
