// search.h - the direction of least cost, by ever smaller steps around the best
#ifndef STEREO_SEARCH_H
#define STEREO_SEARCH_H

#include "core/math/vec.h"

enum { SEARCH_SIDES = 6, SEARCH_STARTS = 48 };

struct search {
    void *context;
    double (*settle)(void *context, vec3 normal);  // adapt weights there; its cost from now on
    double (*cost)(void *context, vec3 normal);
    void (*accept)(void *context);  // what was computed last is the best
    double first, last;             // steps, radians
    vec3 eye;                       // normals face it
};

vec3 search_find(const struct search *search, vec3 start);
// One of SEARCH_STARTS normals all around the eye, a spiral.
vec3 search_start(int i, vec3 eye);
// One of SEARCH_SIDES directions at that angle around `n`, turned by `turn`.
vec3 search_beside(vec3 n, double angle, int side, double turn);

#endif
