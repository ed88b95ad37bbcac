// texels.h - rectangles on planes, and what their texels show
#ifndef DISTANCE_TEXELS_H
#define DISTANCE_TEXELS_H

#include "shape/distance/partition.h"

// The least rectangle about the triangles of plane `number`, its texels not made. The error is the
// soup's vertices' farthest from the plane.
void texels_lay(struct relume_billboard *out, const struct soup *s, const struct partition *p,
                size_t number, vec3 *scratch);
// Its texels, of side `side`: a whole number of them, about the same middle. False: above `most`.
bool texels_size(struct relume_billboard *b, double side, size_t most);
// What they show: the plane's triangles, and in gaps others that lie within `error` of it and turn
// from it by no more than `least_cosine` says, so that pictures that meet do not part.
struct filling {
    double error, least_cosine;
    const uint32_t *owner;  // [triangles of the soup]: their planes
    float *shown;           // [2 * texels of the billboard], for its use
};
void texels_fill(struct relume_billboards *cloud, size_t number, const struct soup *s,
                 const struct partition *p, const struct filling *f);

#endif
