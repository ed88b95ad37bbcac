// slopes.h - the smooth surface that whole steps were cut from
#ifndef LOSSY_SLOPES_H
#define LOSSY_SLOPES_H

#include <relume/image.h>
#include <stdint.h>

// Into the pixels of `out`, of one channel, from steps[height][width]: within half a step of each.
// Where neighbours differ by one step they are treated as a slope and crossed between the two; 0 is
// no surface. RELUME_ENOMEM.
relume_status slopes_of_steps(struct relume_image *out, const uint16_t *steps);

#endif
