// exposure.h - the exposure that a page opens with
#ifndef PUBLISH_EXPOSURE_H
#define PUBLISH_EXPOSURE_H

#include "site/publish/site.h"

#include <relume/pack.h>

// Raking light is dim: in EV, 0 to 2, what makes the first picture brighter, but never so much that
// light from the front would burn it out. Errors of relume_frame.
relume_status exposure_find(double *ev, relume_pack *pack, const struct site *site);

#endif
