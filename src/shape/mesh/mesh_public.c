// mesh_public.c - meshes as callers of the library see them, made of what the readers give
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/math/fnv.h"
#include "shape/mesh/mesh_read.h"

#include <relume/shape/mesh.h>
#include <string.h>

void relume_mesh_free(struct relume_mesh *mesh)
{
    mem_free(mesh->position);
    mem_free(mesh->normal);
    mem_free(mesh->texture);
    mem_free(mesh->colour);
    mem_free(mesh->triangle);
    mem_free(mesh->part);
    for (int i = 0; mesh->part_name && i < mesh->parts; i++)
        mem_free(mesh->part_name[i]);
    mem_free(mesh->part_name);
    mem_free(mesh->picture);
    *mesh = (struct relume_mesh){0};
}

// ---------------------------------------------------------------- vertices that are alike

static bool is_alike(const struct mesh_file *f, size_t a, size_t b)
{
    return !memcmp(&f->mesh.vertices[a], &f->mesh.vertices[b], sizeof *f->mesh.vertices) &&
           (!f->colour || !memcmp(f->colour[a], f->colour[b], sizeof *f->colour));
}

static size_t hash_of(const struct vertex *v)
{
    const uint64_t hash = fnv_of_words(FNV_START, v, sizeof *v);
    return (size_t)(hash ^ hash >> 29);
}

// Vertices move down to the first that is like them, triangles follow. An empty slot is 0, others
// are numbers of vertices counted from 1.
static relume_status weld(struct mesh_file *f)
{
    struct mesh *m = &f->mesh;
    size_t slots = 16;
    while (slots < 2 * m->vertex_count)
        slots *= 2;
    uint32_t *slot = mem_zeroed(slots, sizeof *slot);
    uint32_t *number = mem_array(m->vertex_count, sizeof *number);
    size_t kept = 0;
    for (size_t i = 0; slot && number && i < m->vertex_count; i++) {
        size_t s = hash_of(&m->vertices[i]) & (slots - 1);
        while (slot[s] && !is_alike(f, slot[s] - 1, i))
            s = (s + 1) & (slots - 1);
        if (!slot[s]) {
            m->vertices[kept] = m->vertices[i];
            if (f->colour)
                memcpy(f->colour[kept], f->colour[i], sizeof *f->colour);
            slot[s] = (uint32_t)++kept;
        }
        number[i] = slot[s] - 1;
    }
    for (size_t i = 0; slot && number && i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            m->triangles[i].vertex[k] = number[m->triangles[i].vertex[k]];
    if (slot && number)
        m->vertex_count = kept;
    const bool good = slot && number;
    mem_free(slot);
    mem_free(number);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- reading

static void take_vertices(struct relume_mesh *out, const struct mesh *m)
{
    for (size_t i = 0; i < m->vertex_count; i++) {
        const struct vertex *v = &m->vertices[i];
        memcpy(out->position[i], v->position, sizeof out->position[i]);
        memcpy(out->normal[i], v->normal, sizeof out->normal[i]);
        if (out->texture)
            memcpy(out->texture[i], v->texture, sizeof out->texture[i]);
    }
}

static void take_triangles(struct relume_mesh *out, const struct mesh *m)
{
    for (size_t i = 0; i < m->triangle_count; i++) {
        memcpy(out->triangle[i], m->triangles[i].vertex, sizeof out->triangle[i]);
        if (out->part)
            out->part[i] = m->triangles[i].material;
    }
}

// All that is in the file goes over; what has been copied is freed first.
static relume_status take_mesh(struct relume_mesh *out, struct mesh_file *f)
{
    struct mesh *m = &f->mesh;
    const size_t vertices = m->vertex_count, triangles = m->triangle_count;
    out->position = mem_array(vertices, sizeof *out->position);
    out->normal = mem_array(vertices, sizeof *out->normal);
    out->texture = f->has_uv ? mem_array(vertices, sizeof *out->texture) : NULL;
    if (!out->position || !out->normal || (f->has_uv && !out->texture))
        return RELUME_ENOMEM;
    take_vertices(out, m);
    mem_free(m->vertices);
    m->vertices = NULL;
    out->triangle = mem_array(triangles, sizeof *out->triangle);
    out->part = f->parts > 1 ? mem_array(triangles, sizeof *out->part) : NULL;
    if (!out->triangle || (f->parts > 1 && !out->part))
        return RELUME_ENOMEM;
    take_triangles(out, m);
    out->vertex_count = vertices;
    out->triangle_count = triangles;
    out->colour = f->colour;
    out->part_name = f->part;
    out->parts = f->parts;
    out->picture = f->picture;
    f->colour = NULL;
    f->part = NULL;
    f->parts = 0;
    f->picture = NULL;
    return RELUME_OK;
}

relume_status relume_mesh_read(struct relume_mesh *out, const char *path,
                               const struct relume_mesh_params *params)
{
    const struct relume_mesh_params p = PARAMS(relume_mesh_params, params);
    struct mesh_file file;
    *out = (struct relume_mesh){0};
    relume_status status = mesh_read(&file, path, p.log);
    if (!status)
        status = weld(&file);
    if (!status)
        status = take_mesh(out, &file);
    mesh_file_free(&file);
    if (status)
        relume_mesh_free(out);
    return status;
}
