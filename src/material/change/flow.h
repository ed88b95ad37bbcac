// flow.h - what a homography leaves of the displacement between two captures
#ifndef CHANGE_FLOW_H
#define CHANGE_FLOW_H

#include "material/change/level.h"

// Adds displacements to `place` (a homography so far) so that `b`, made as `a` by `level`, lies on
// it: smooth over some ten pixels, places that have changed left aside. `longest` is the largest of
// them, pixels. RELUME_ENOMEM.
relume_status flow_find(struct place *place, double *longest, const struct surface *a,
                        const struct surface *b, const struct level *level, int threads);

#endif
