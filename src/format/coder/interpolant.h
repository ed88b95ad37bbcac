// interpolant.h - the interpolants behind relume_interpolants
#ifndef CODER_INTERPOLANT_H
#define CODER_INTERPOLANT_H

#include <relume/format/coder.h>

extern const struct relume_interpolant interpolant_chord;
extern const struct relume_interpolant interpolant_delaunay;
extern const struct relume_interpolant interpolant_angular;
extern const struct relume_interpolant interpolant_tps;
extern const struct relume_interpolant interpolant_gaussian;
extern const struct relume_interpolant interpolant_rbf;
extern const struct relume_interpolant interpolant_hsh;
extern const struct relume_interpolant interpolant_natural;
extern const struct relume_interpolant interpolant_octahedral;

// The mean distance of a light to the nearest other one.
double interpolant_spacing(const struct relume_vec3 *lights, int n);

// The parameters of `chord` with which the lights of `samples` predict each other best, and with
// what error: the geometric mean over lights of each one's RMS.
relume_status interpolant_choose(double *parameter, double *rms, const struct relume_vec3 *lights,
                                 const struct relume_samples *samples, int threads);

#endif
