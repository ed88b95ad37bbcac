// tangents.c - a tangent frame for every vertex, in the manner of MikkTSpace (Mikkelsen 2008)
#include "shape/mesh/tangents.h"

#include "core/base/memory.h"

#include <string.h>

enum { KEY = 12 };  // position, normal, texture, handedness, colour

struct corner {
    float key[KEY];
    size_t number;  // 3 * triangle + corner
};

static int by_key(const void *a, const void *b)
{
    const struct corner *x = a, *y = b;
    const int order = memcmp(x->key, y->key, sizeof x->key);
    return order ? order : x->number < y->number ? -1 : x->number > y->number;
}

// The way of growing s in a triangle, and the sign of its texture's area; zero where it has none.
static vec3 along_s(const struct mesh *mesh, const uint32_t v[3], double *handedness)
{
    const struct vertex *a = &mesh->vertices[v[0]];
    vec3 edge[2];
    double s[2], up[2];
    for (int i = 0; i < 2; i++) {
        const struct vertex *b = &mesh->vertices[v[i + 1]];
        edge[i] = vec3_sub(vertex_position(b), vertex_position(a));
        s[i] = (double)b->texture[0] - (double)a->texture[0];
        up[i] = (double)a->texture[1] - (double)b->texture[1];
    }
    const double area = s[0] * up[1] - s[1] * up[0];
    *handedness = area < 0.0 ? -1.0 : 1.0;
    const vec3 along = vec3_sub(vec3_scale(edge[0], up[1]), vec3_scale(edge[1], up[0]));
    return vec3_scale(along, area == 0.0 ? 0.0 : *handedness);
}

static void fill_corners(struct corner *corner, const struct mesh *mesh, float (*tint)[3])
{
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++) {
        const uint32_t *v = mesh->triangles[i / 3].vertex;
        const struct vertex *from = &mesh->vertices[v[i % 3]];
        double handedness;
        (void)along_s(mesh, v, &handedness);
        float *key = corner[i].key;
        for (int c = 0; c < 3; c++) {
            key[c] = from->position[c] + 0.0f;  // one zero, not two
            key[3 + c] = from->normal[c] + 0.0f;
        }
        key[6] = from->texture[0] + 0.0f;
        key[7] = from->texture[1] + 0.0f;
        key[8] = (float)handedness;
        for (int c = 0; c < 3; c++)
            key[9 + c] = tint ? tint[v[i % 3]][c] : 1.0f;
        corner[i].number = i;
    }
}

// Corners of equal keys become one vertex.
static void join(struct tangents *out, const struct corner *corner, size_t corners)
{
    for (size_t i = 0; i < corners; i++) {
        if (!i || memcmp(corner[i].key, corner[i - 1].key, sizeof corner[i].key)) {
            struct relume_mesh_vertex *v = &out->vertices[out->vertex_count++];
            const float *key = corner[i].key;
            memcpy(v->position, key, sizeof v->position);
            memcpy(v->normal, key + 3, sizeof v->normal);
            memcpy(v->texture, key + 6, sizeof v->texture);
            v->tangent[3] = key[8];
            if (out->tint)
                memcpy(out->tint[out->vertex_count - 1], key + 9, sizeof *out->tint);
        }
        const size_t number = corner[i].number;
        out->triangles[number / 3][number % 3] = (uint32_t)(out->vertex_count - 1);
    }
}

static vec3 normal_of(const struct relume_mesh_vertex *v)
{
    return vec3_of((double)v->normal[0], (double)v->normal[1], (double)v->normal[2]);
}

static vec3 off_normal(vec3 a, vec3 n)
{
    return vec3_sub(a, vec3_scale(n, vec3_dot(a, n)));
}

static double angle_at(const struct mesh *mesh, const uint32_t v[3], int corner)
{
    const vec3 at = vertex_position(&mesh->vertices[v[corner]]);
    const vec3 a = vec3_sub(vertex_position(&mesh->vertices[v[(corner + 1) % 3]]), at);
    const vec3 b = vec3_sub(vertex_position(&mesh->vertices[v[(corner + 2) % 3]]), at);
    const double la = vec3_length(a), lb = vec3_length(b);
    return la > 0.0 && lb > 0.0 ? vec3_angle(vec3_scale(a, 1.0 / la), vec3_scale(b, 1.0 / lb))
                                : 0.0;
}

static void add_tangents(vec3 *sum, const struct tangents *out, const struct mesh *mesh)
{
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        double handedness;
        const vec3 along = along_s(mesh, mesh->triangles[i].vertex, &handedness);
        for (int k = 0; k < 3; k++) {
            const uint32_t at = out->triangles[i][k];
            const vec3 flat = off_normal(along, normal_of(&out->vertices[at]));
            const double length = vec3_length(flat);
            if (length > 0.0)
                sum[at] = vec3_along(sum[at], flat,
                                     angle_at(mesh, mesh->triangles[i].vertex, k) / length);
        }
    }
}

// Any unit vector across `n`.
static vec3 across(vec3 n)
{
    const vec3 axis = fabs(n.x) < 0.7 ? vec3_of(1, 0, 0) : vec3_of(0, 1, 0);
    return vec3_unit(off_normal(axis, n));
}

relume_status tangents_make(struct tangents *out, const struct mesh *mesh, float (*tint)[3])
{
    const size_t corners = 3 * mesh->triangle_count;
    struct corner *corner = mem_array(corners, sizeof *corner);
    *out = (struct tangents){
        .vertices = mem_array(corners, sizeof *out->vertices),
        .tint = tint ? mem_array(corners, sizeof *out->tint) : NULL,
        .triangles = mem_array(mesh->triangle_count, sizeof *out->triangles),
    };
    vec3 *sum = mem_zeroed(corners, sizeof *sum);
    const bool allocated = corner && out->vertices && out->triangles && sum && (out->tint || !tint);
    if (allocated) {
        fill_corners(corner, mesh, tint);
        qsort(corner, corners, sizeof *corner, by_key);
        join(out, corner, corners);
        add_tangents(sum, out, mesh);
    }
    for (size_t i = 0; allocated && i < out->vertex_count; i++) {
        struct relume_mesh_vertex *v = &out->vertices[i];
        const bool flat = !(vec3_length(sum[i]) > 1e-12);
        const vec3 t = flat ? across(normal_of(v)) : vec3_unit(off_normal(sum[i], normal_of(v)));
        v->tangent[0] = (float)t.x, v->tangent[1] = (float)t.y, v->tangent[2] = (float)t.z;
        out->flat += flat;
    }
    mem_free(corner);
    mem_free(sum);
    return allocated ? RELUME_OK : RELUME_ENOMEM;
}
