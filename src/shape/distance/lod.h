// lod.h - which level of detail is drawn
#ifndef DISTANCE_LOD_H
#define DISTANCE_LOD_H

#include <relume/shape/billboards.h>

#define RELUME_BILLBOARD_NONE UINT32_MAX

// How many pixels an error of length `error` is seen as from `distance` away, by a view of
// `view_rad` upright over `height` pixels (of the middle of the view; Meseth 2008, chapter 6).
// Infinite for a distance of 0.
double relume_lod_pixels(double error, double distance, double view_rad, int height);
// The coarsest of `n` levels whose errors ascend that is seen within `pixels`; 0 where none is.
int relume_lod_choose(const double *error, int n, double pixels, double distance, double view_rad,
                      int height);

// How urgent it is to turn a level of error `current` into one of error `target`, both above 0:
// max(current / target, target / current), at least 1; of what is not seen 1 - 1 / that, below 1
// (Meseth 2008, chapter 6).
double relume_lod_priority(double current, double target, bool seen);

#endif
