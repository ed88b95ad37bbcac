// geodesic.h - distances along a surface of triangles
#ifndef REFLECT_GEODESIC_H
#define REFLECT_GEODESIC_H

#include "core/math/vec.h"
#include "world/reflect/reflection.h"

#include <relume/world/reflection.h>

// The surface with vertices in equal places joined, and what meets at each.
struct geodesic_mesh {
    size_t vertices, triangles, given;
    vec3 *position;                       // [vertices]
    uint32_t *joined;                     // [given]: the vertex that one of the surface's became
    uint32_t (*triangle)[3];              // [triangles]
    size_t *first;                        // [vertices + 1]: of its triangles in ...
    uint32_t *around;                     // [3 triangles]
    const uint32_t (*given_triangle)[3];  // borrowed, of the surface
    double edge;                          // mean length
};
// Triangles name vertices that are there. RELUME_ENOMEM. The caller frees what is in `out`,
// whatever is returned.
relume_status geodesic_mesh_create(struct geodesic_mesh *out,
                                   const struct relume_reflection_surface *surface);
void geodesic_mesh_free(struct geodesic_mesh *mesh);

// The place of the surface that is nearest to `point`; false where there is no triangle.
bool geodesic_locate(struct relume_reflection_place *out, const struct geodesic_mesh *mesh,
                     vec3 point);

// distance[given]: from the place of the surface nearest to `point` to each of its vertices;
// infinite for pieces that do not hang together with it. RELUME_ENOMEM.
relume_status geodesic_distances(float *distance, const struct geodesic_mesh *mesh, vec3 point);

#endif
