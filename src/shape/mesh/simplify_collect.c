// simplify_collect.c - the triangles that are left become a mesh of their own
#include "shape/mesh/simplify_run.h"

#include <string.h>

static void copy_vertex(struct relume_mesh *out, size_t to, const struct relume_mesh *m,
                        float (*shown)[3], size_t i)
{
    memcpy(out->position[to], m->position[i], sizeof *out->position);
    memcpy(out->normal[to], m->normal[i], sizeof *out->normal);
    if (shown && memcmp(shown[i], m->normal[i], sizeof *shown))
        vec3_store(out->normal[to], vec3_unit(vec3_floats(shown[i])));
    if (out->texture)
        memcpy(out->texture[to], m->texture[i], sizeof *out->texture);
    if (out->colour)
        memcpy(out->colour[to], m->colour[i], sizeof *out->colour);
}

static relume_status copy_names(struct relume_mesh *out, const struct relume_mesh *m)
{
    out->picture = m->picture ? mem_text(m->picture) : NULL;
    out->cut_out = m->cut_out;
    if (m->picture && !out->picture)
        return RELUME_ENOMEM;
    if (!m->part_name || !m->parts)
        return RELUME_OK;
    if (!(out->part_name = mem_zeroed((size_t)m->parts, sizeof *out->part_name)))
        return RELUME_ENOMEM;
    out->parts = m->parts;
    for (int i = 0; i < m->parts; i++)
        if (!(out->part_name[i] = mem_text(m->part_name[i] ? m->part_name[i] : "")))
            return RELUME_ENOMEM;
    return RELUME_OK;
}

static size_t number_vertices(const struct connect *c, uint32_t *number)
{
    size_t n = 0;
    memset(number, 0xff, c->vertices * sizeof *number);
    for (size_t t = 0; t < c->triangles; t++)
        for (int k = 0; c->triangle[t][0] != NOTHING && k < 3; k++)
            number[c->triangle[t][k]] = 0;
    for (size_t i = 0; i < c->vertices; i++)
        if (!number[i])
            number[i] = (uint32_t)n++;
    return n;
}

relume_status run_collect(struct relume_mesh *out, const struct connect *c,
                          const struct relume_mesh *m, float (*shown)[3])
{
    uint32_t *number = mem_array(c->vertices, sizeof *number);
    if (!number)
        return RELUME_ENOMEM;
    const size_t vertices = number_vertices(c, number);
    out->position = mem_array(vertices, sizeof *out->position);
    out->normal = mem_array(vertices, sizeof *out->normal);
    out->texture = m->texture ? mem_array(vertices, sizeof *out->texture) : NULL;
    out->colour = m->colour ? mem_array(vertices, sizeof *out->colour) : NULL;
    out->triangle = mem_array(c->alive, sizeof *out->triangle);
    out->part = m->part ? mem_array(c->alive, sizeof *out->part) : NULL;
    const bool good = out->position && out->normal && out->triangle &&
                      (!m->texture || out->texture) && (!m->colour || out->colour) &&
                      (!m->part || out->part);
    for (size_t i = 0; good && i < c->vertices; i++)
        if (number[i] != NOTHING)
            copy_vertex(out, number[i], m, shown, i);
    for (size_t t = 0; good && t < c->triangles; t++) {
        if (c->triangle[t][0] == NOTHING)
            continue;
        for (int k = 0; k < 3; k++)
            out->triangle[out->triangle_count][k] = number[c->triangle[t][k]];
        if (out->part)
            out->part[out->triangle_count] = m->part[t];
        out->triangle_count++;
    }
    out->vertex_count = good ? vertices : 0;
    mem_free(number);
    return good ? copy_names(out, m) : RELUME_ENOMEM;
}
