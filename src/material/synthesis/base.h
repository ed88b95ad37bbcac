// base.h - the numbers of which the places of waves are multiples
#ifndef SYNTHESIS_BASE_H
#define SYNTHESIS_BASE_H

#include <relume/material/synthesis.h>

enum { BASE_MOST = 12 };  // candidates
// From a multiple, periods of the sample: what is farther is another wave.
#define BASE_FAR 0.35

// What fits the places of `count` waves along x (or along y), best first, at most BASE_MOST; their
// number. Waves that stand still that way do not count; when all do there is one candidate, 0.
int base_candidates(double out[BASE_MOST], const struct relume_wave *wave, int count, bool along_x);

// The multiple of `base` next to b.
int base_multiple(double b, double base);

#endif
