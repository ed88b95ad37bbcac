// near.h - which points lie near which
#ifndef DISTANCE_NEAR_H
#define DISTANCE_NEAR_H

#include "core/math/vec.h"

// The `n` nearest others of each of `count` points, by a k-d tree: out[count][n], the farthest
// first; of fewer points the rest is `count`. RELUME_ENOMEM.
relume_status near_find(uint32_t *out, const vec3 *point, size_t count, int n);

#endif
