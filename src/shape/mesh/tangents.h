// tangents.h - a tangent frame for every vertex, in the manner of MikkTSpace (Mikkelsen 2008):
// tangents of triangles, projected onto the normal and weighted by angle, are shared by corners of
// equal place, normal, texture coordinates, colour and handedness; mirrored sides never share
#ifndef MESH_TANGENTS_H
#define MESH_TANGENTS_H

#include "shape/mesh/mesh.h"

#include <relume/shape/mesh.h>

struct tangents {
    struct relume_mesh_vertex *vertices;
    size_t vertex_count;
    float (*tint)[3];          // of each vertex, or NULL
    uint32_t (*triangles)[3];  // as many as the mesh has, in its order
    size_t flat;               // vertices whose texture has no direction; they have some tangent
};
// `tint`: of each vertex of the mesh, or NULL. RELUME_ENOMEM. The caller frees what is in `out`.
relume_status tangents_make(struct tangents *out, const struct mesh *mesh, float (*tint)[3]);

#endif
