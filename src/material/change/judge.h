// judge.h - which differences are more than chance
#ifndef CHANGE_JUDGE_H
#define CHANGE_JUDGE_H

#include "material/change/surface.h"

#include <relume/material/change.h>

// From two surfaces that lie on each other: fills degrees, delta_e, significance, changed and the
// measures of noise of `out`, whose size is set. RELUME_ENOMEM.
relume_status judge(struct relume_change *out, const struct surface *a, const struct surface *b,
                    const struct relume_change_params *params);

// `changed` as places: connected pixels (8 neighbours), those of fewer than `least` pixels taken
// out of it. RELUME_ENOMEM.
relume_status places_find(struct relume_change *out, int least);

#endif
