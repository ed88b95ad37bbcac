// fit.h - one pixel's colour, gloss and normal from what it shows
//
// Residuals are taken in a display-like coding, so that highlights do not drown the rest, and
// bounded (Geman and McClure 1987): what is much darker than the model stands in a shadow, what is
// much brighter has light that the model has not; the former is more common and forgiven earlier.
#ifndef APPEARANCE_FIT_H
#define APPEARANCE_FIT_H

#include "material/maps/ggx.h"

// The colour that fits best, in [0, 1], for a gloss and a normal; `albedo` is that of a matte
// surface. Returns the mean bounded square of the residuals.
float gloss_try(float colour[3], const struct look *k, const struct gloss *g, const float normal[3],
                const float albedo[3]);

// A normal to begin with, where `matte` is that of a matte surface: what only mirrors is brightest
// where the light's mirror image is, halfway to the eye.
void gloss_start(float normal[3], const struct look *k, const struct gloss *g,
                 const float matte[3]);
// Improve the normal, in at most so many turns, and the colour with it; `start` holds it loosely.
// Returns as gloss_try, and leaves the look turned to the normal, of that gloss.
float gloss_straighten(float normal[3], float colour[3], const struct look *k,
                       const struct gloss *g, const float start[3], int turns);

#endif
