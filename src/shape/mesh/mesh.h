// mesh.h - triangles with normals and texture coordinates, grown piece by piece
#ifndef MESH_MESH_H
#define MESH_MESH_H

#include "image/geometry/frame.h"

struct vertex {
    float position[3];
    float normal[3];   // unit
    float texture[3];  // (u, v, 0) for pictures, a place in the solid for wood and stone
};

struct triangle {
    uint32_t vertex[3];
    uint32_t material;
};

// Zero-filled is empty. When memory runs out `failed` is set, further additions do nothing, and
// whoever finishes the mesh reports it once.
struct mesh {
    struct vertex *vertices;
    struct triangle *triangles;
    size_t vertex_count, triangle_count;
    bool failed;
};

void mesh_free(struct mesh *mesh);

// The new vertex's number (0 when memory ran out).
uint32_t mesh_vertex(struct mesh *mesh, vec3 position, vec3 normal, vec3 texture);
void mesh_triangle(struct mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t material);
// Add a copy of `part`, moved to `frame`, all of it of one material. Texture places are shifted by
// `shift`, so that two boards of one wood do not look alike.
void mesh_append(struct mesh *mesh, const struct mesh *part, const struct frame *frame,
                 uint32_t material, vec3 shift);

// Normals from the triangles around each vertex, weighted by their angle there (Thuermer and
// Wuethrich 1998).
void mesh_smooth(struct mesh *mesh);

struct bounds {
    vec3 min, max;
};
struct bounds mesh_bounds(const struct mesh *mesh);

static inline vec3 vertex_position(const struct vertex *v)
{
    return vec3_floats(v->position);
}

static inline vec3 vertex_normal(const struct vertex *v)
{
    return vec3_floats(v->normal);
}

static inline void mesh_corners(vec3 corner[3], const struct mesh *mesh, size_t triangle)
{
    for (int k = 0; k < 3; k++)
        corner[k] = vertex_position(&mesh->vertices[mesh->triangles[triangle].vertex[k]]);
}

// Twice the area of a triangle times its normal.
static inline vec3 mesh_twice_area(const vec3 corner[3])
{
    return vec3_cross(vec3_sub(corner[1], corner[0]), vec3_sub(corner[2], corner[0]));
}

#endif
