// light_match.h - a list of lights compared with the directions in which a ball shows them
#ifndef ACQUIRE_LIGHT_MATCH_H
#define ACQUIRE_LIGHT_MATCH_H

#include "core/math/vec.h"

enum light_match_kind {
    LIGHT_MATCH_NONE,    // the directions have nothing to do with the list
    LIGHT_MATCH_SAME,    // the list is right, but for single lights
    LIGHT_MATCH_TURNED,  // it fits with other axes, or turned in the plane of the picture
    LIGHT_MATCH_ORDER,   // it fits in another order
    LIGHT_MATCH_UNIT,    // positions fit in another unit
};

// Result of a comparison; angles are degrees.
struct light_match {
    enum light_match_kind kind;
    double off;      // median angle between list and ball
    double left;     // the same once the list is mended
    bool half_turn;  // TURNED: x and y are both turned round
    double unit;     // UNIT: positions fit if they are multiplied by it
    char mend[96];   // "y is turned round": the list fits if ...; "" for SAME and NONE
};

// Compares n lights of a list with unit directions seen[n]; zero vectors there were not seen.
// A ball sees near lights at other angles than the object does. One common offset accounts for
// that. With `near` lights list[n] holds positions, and `ball` the position of the ball; NULL
// otherwise. `sigma` is the usual error of the ball's directions, degrees. The remaining angles
// fill angle[n]. The nearest lights of the list fill partner[n]. Both are NAN and -1 where a light
// was not seen.
void light_match(struct light_match *out, double *angle, int *partner, const vec3 *list,
                 const vec3 *seen, int n, double sigma, const vec3 *ball);

#endif
