// interpolant.h - the interpolants behind relume_interpolants
#ifndef CODER_INTERPOLANT_H
#define CODER_INTERPOLANT_H

#include <relume/coder.h>

extern const struct relume_interpolant interpolant_delaunay;
extern const struct relume_interpolant interpolant_angular;
extern const struct relume_interpolant interpolant_tps;
extern const struct relume_interpolant interpolant_rbf;
extern const struct relume_interpolant interpolant_hsh;
extern const struct relume_interpolant interpolant_natural;
extern const struct relume_interpolant interpolant_octahedral;

#endif
