// integrable.h - the linear map of the lights for which the normals belong to a surface of heights
#ifndef ACQUIRE_INTEGRABLE_H
#define ACQUIRE_INTEGRABLE_H

#include "core/math/vec.h"

// Surface vectors (albedo x normal, any common scale) at the crossings of a lattice of pixels.
struct lattice {
    int columns, rows;
    const int *slot;  // [rows][columns]: index into g, or -1
    const vec3 *g;
    const bool *known;
};

// The map A, row by row, by which lights become A l and surface vectors A^-T g, such that the
// slopes of the surface have no curl; what that leaves open (the generalised bas-relief
// transformations, Belhumeur, Kriegman, Yuille 1999) stays as near to the identity as it can.
// `curl` is the RMS of the curl before and after, relative to the slopes' other derivatives. False
// where fewer than some hundred crossings have neighbours, or memory is short.
bool integrable_map(double a[9], double curl[2], const struct lattice *lattice);

#endif
