// mesh.c - triangles with normals and texture coordinates, grown piece by piece
#include "shape/mesh/mesh.h"

#include "core/base/memory.h"

#include <string.h>

void mesh_free(struct mesh *mesh)
{
    mem_free(mesh->vertices);
    mem_free(mesh->triangles);
    *mesh = (struct mesh){0};
}

uint32_t mesh_vertex(struct mesh *mesh, vec3 position, vec3 normal, vec3 texture)
{
    mesh->failed = mesh->failed || mesh->vertex_count >= UINT32_MAX ||
                   !mem_grow(&mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices);
    if (mesh->failed)
        return 0;
    struct vertex *v = mesh->vertices + mesh->vertex_count;
    vec3_store(v->position, position);
    vec3_store(v->normal, normal);
    vec3_store(v->texture, texture);
    return (uint32_t)mesh->vertex_count++;
}

void mesh_triangle(struct mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t material)
{
    mesh->failed = mesh->failed || mesh->triangle_count >= UINT32_MAX ||
                   !mem_grow(&mesh->triangles, mesh->triangle_count, sizeof *mesh->triangles);
    if (!mesh->failed)
        mesh->triangles[mesh->triangle_count++] = (struct triangle){{a, b, c}, material};
}

void mesh_append(struct mesh *mesh, const struct mesh *part, const struct frame *frame,
                 uint32_t material, vec3 shift)
{
    const uint32_t first = (uint32_t)mesh->vertex_count;
    mesh->failed |= part->failed;
    for (size_t i = 0; i < part->vertex_count; i++) {
        const struct vertex *v = &part->vertices[i];
        const vec3 texture = vec3_of(v->texture[0], v->texture[1], v->texture[2]);
        mesh_vertex(mesh, frame_point(frame, vertex_position(v)),
                    frame_normal(frame, vertex_normal(v)), vec3_add(texture, shift));
    }
    for (size_t i = 0; i < part->triangle_count; i++) {
        const uint32_t *v = part->triangles[i].vertex;
        mesh_triangle(mesh, first + v[0], first + v[1], first + v[2], material);
    }
}

static void add_corner(struct vertex *at, vec3 normal, vec3 left, vec3 right)
{
    const double l = vec3_length(left), r = vec3_length(right);
    if (l <= 0.0 || r <= 0.0)
        return;
    const double angle = vec3_angle(vec3_scale(left, 1.0 / l), vec3_scale(right, 1.0 / r));
    vec3_store(at->normal, vec3_along(vertex_normal(at), normal, angle));
}

void mesh_smooth(struct mesh *mesh)
{
    for (size_t i = 0; i < mesh->vertex_count; i++)
        vec3_store(mesh->vertices[i].normal, vec3_of(0, 0, 0));
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        struct vertex *v[3];
        vec3 p[3];
        for (int k = 0; k < 3; k++) {
            v[k] = &mesh->vertices[mesh->triangles[i].vertex[k]];
            p[k] = vertex_position(v[k]);
        }
        const vec3 across = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
        if (vec3_length(across) <= 0.0)
            continue;
        for (int k = 0; k < 3; k++)
            add_corner(v[k], vec3_unit(across), vec3_sub(p[(k + 1) % 3], p[k]),
                       vec3_sub(p[(k + 2) % 3], p[k]));
    }
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const vec3 n = vertex_normal(&mesh->vertices[i]);
        vec3_store(mesh->vertices[i].normal,
                   vec3_length(n) > 0.0 ? vec3_unit(n) : vec3_of(0, 0, 1));
    }
}

struct bounds mesh_bounds(const struct mesh *mesh)
{
    struct bounds b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const vec3 p = vertex_position(&mesh->vertices[i]);
        b.min = vec3_of(fmin(b.min.x, p.x), fmin(b.min.y, p.y), fmin(b.min.z, p.z));
        b.max = vec3_of(fmax(b.max.x, p.x), fmax(b.max.y, p.y), fmax(b.max.z, p.z));
    }
    return b;
}
