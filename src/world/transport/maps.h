// maps.h - imperfect shadow maps (Ritschel et al. 2008): many small depth maps, each drawn from
// some points of a surface, whose holes are filled
#ifndef TRANSPORT_MAPS_H
#define TRANSPORT_MAPS_H

#include "world/transport/points.h"

// How a map looks at the world. Zeroed: it sees nothing, and hides nothing.
enum map_kind {
    MAP_NONE,
    MAP_HEMISPHERE,  // all before its place, as a paraboloid (Brabec et al. 2002)
    MAP_CONE,        // a ball, from a place outside of it
    MAP_FAR,         // along its direction from far away, ever coarser off a middle
};
struct map_look {
    enum map_kind kind;
    vec3 place;    // of MAP_FAR the middle
    vec3 x, y, z;  // unit: z is the way it looks
    double width;  // of MAP_CONE the tangent of its half angle, of MAP_FAR half of it is that near
};
// Of the hemisphere about the normal of a place.
struct map_look map_of_hemisphere(vec3 place, vec3 normal);
// Of a ball as it is seen from a place; the hemisphere about `normal` if that is in it.
struct map_look map_of_ball(vec3 place, vec3 normal, vec3 middle, double radius);
// Of light that comes from far away, unit `towards` it; half of the map shows what is as near to
// the middle as that.
struct map_look map_of_far(vec3 towards, vec3 middle, double radius);

// Of `count` maps of `size` x `size`.
struct maps {
    struct map_look *look;  // [count]
    float *depth;           // [count][size][size]; infinite: nothing is there
    size_t count;
    int size;
    double square;  // the side of what a point of a map stands for
};
struct maps_params {
    size_t points;  // for each map, at most
    bool unfilled;  // holes are left
    int threads;
};
// Draws the maps, whose looks and memory for whose depths the caller has made: each from a run of
// its own of the points. RELUME_ENOMEM.
relume_status maps_draw(struct maps *m, const struct points *points, const struct maps_params *p);
// Holes are filled where levels of half the size know a surface, and what is seen through holes of
// one is covered ("pull-push": Grossman and Dally 1998; Marroquim et al. 2007). Depths are one
// surface where they differ by less than `apart`, twice as much at each level. `levels` holds
// size^2 / 2.
struct map_level {
    float depth, spread;  // the mean of the nearest of four that are one surface, and their range
    int members;          // how many of them are: 2 to 4, or 0
};
void maps_fill(float *depth, int size, double apart, struct map_level *levels);
// Whether a map has nothing before a place on a surface of that normal.
bool maps_open(const struct maps *m, size_t map, vec3 place, vec3 normal);

#endif
