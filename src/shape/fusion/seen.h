// seen.h - what of a mesh the views see, and in which colours
#ifndef FUSION_SEEN_H
#define FUSION_SEEN_H

#include "shape/fusion/witness.h"

#include <relume/renderer.h>
#include <relume/shape/mesh.h>

// Leave out triangles of which two vertices lie farther than `near` from what any view sees, or
// no view sees from its front, and vertices that are left without; normals are made anew.
// `*left_out` counts triangles. RELUME_ENOMEM.
relume_status seen_keep(struct relume_mesh *mesh, size_t *left_out, const struct witness *witness,
                        int witnesses, double near, int threads);
// How well a view sees a place with that unit normal: the cosine of both, squared; 0 where it sees
// something farther than `near` from it, or sees it from the side. `*at` is what it says.
double seen_weight(struct sighting *at, const struct witness *s, vec3 place, vec3 normal,
                   double near);
// Colours of vertices: the mean of what relit views show, of those more that see it from before.
// Errors of relume_renderer_frame, RELUME_ENOMEM.
relume_status seen_colour(struct relume_mesh *mesh, relume_renderer *renderer,
                          const struct witness *witness, int witnesses, double near, int threads);

#endif
