// triangles.h - the triangles of lights over which a basis is linear
#ifndef RELIGHT_TRIANGLES_H
#define RELIGHT_TRIANGLES_H

#include "core/math/vec.h"
#include "format/coder/coding.h"
#include "relight/light/refit.h"

#include <relume/relight/relight.h>

struct triangles {
    int points, count;
    const struct relume_vec3 *point;  // of the coder, in the pole's frame; lights first
    struct relume_weight_triangle *triangle;
    int start[RELUME_WEIGHT_STARTS * RELUME_WEIGHT_STARTS];
};

// `*out` is NULL where there are none, or such that single precision does not bear.
relume_status triangles_create(struct triangles **out, const struct relume_coder_triangles *from,
                               int lights);
void triangles_destroy(struct triangles **triangles);

// Three nodes and their shares of a unit direction of the pole's frame; the shares sum to 1.
void triangles_find(int node[3], float share[3], const struct triangles *triangles, vec3 direction);

#endif
