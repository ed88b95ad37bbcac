// apparatus.h - what a real apparatus does to the photographs of a goniometer
#ifndef SCENE_APPARATUS_H
#define SCENE_APPARATUS_H

#include "core/math/vec.h"

#include <relume/world/scene.h>

// Of a periodic sample of size x size texels. Thread-safety: one thread a worker number.
typedef struct apparatus apparatus;

// NULL in *out where `faults` are none. RELUME_ENOMEM.
relume_status apparatus_create(apparatus **out, const struct relume_btf_faults *faults, int size,
                               uint64_t seed, int workers);
void apparatus_destroy(apparatus **a);

// texels[size][size][3], rectified, as photograph number `number` from `view` would have them.
void apparatus_spoil(const apparatus *a, float *texels, vec3 view, uint64_t number, int worker);

#endif
