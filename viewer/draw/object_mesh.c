// object_mesh.c - vertices and triangles of objects on the GPU
#include "draw/object_mesh.h"
#include "world/object/drawn_objects.h"

#include <stddef.h>

static void fill(const struct gl *gl, GLenum target, GLuint buffer, const void *data, size_t bytes)
{
    gl->BindBuffer(target, buffer);
    gl->BufferData(target, (GLsizeiptr)bytes, data, GL_STATIC_DRAW);
}

// Into the buffers of the vertex array in use.
static void upload_surface(const struct object_mesh *m, const struct relume_objects_info *info)
{
    fill(m->gl, GL_ARRAY_BUFFER, m->vertices, info->vertices,
         info->vertex_count * sizeof *info->vertices);
    fill(m->gl, GL_ELEMENT_ARRAY_BUFFER, m->indices, info->triangles,
         info->triangle_count * sizeof *info->triangles);
    if (info->tint)
        fill(m->gl, GL_ARRAY_BUFFER, m->tints, info->tint, info->vertex_count * sizeof *info->tint);
}

// Attribute 4.
static void create_tints(struct object_mesh *m, const struct relume_objects_info *info)
{
    const struct gl *gl = m->gl;
    enum { TINT_AT = 4 };
    if (!info->tint)
        return;
    gl->GenBuffers(1, &m->tints);
    gl->BindBuffer(GL_ARRAY_BUFFER, m->tints);
    gl->EnableVertexAttribArray(TINT_AT);
    gl->VertexAttribPointer(TINT_AT, 3, GL_FLOAT, GL_FALSE, 0, NULL);
}

void object_mesh_create(struct object_mesh *m, const struct gl *gl,
                        const struct relume_objects_info *info)
{
    static const struct {
        GLint numbers;
        size_t offset;
    } attribute[] = {{3, offsetof(struct relume_mesh_vertex, position)},
                     {3, offsetof(struct relume_mesh_vertex, normal)},
                     {4, offsetof(struct relume_mesh_vertex, tangent)},
                     {2, offsetof(struct relume_mesh_vertex, texture)}};
    *m = (struct object_mesh){.gl = gl};
    gl->GenVertexArrays(1, &m->array);
    gl->BindVertexArray(m->array);
    gl->GenBuffers(1, &m->vertices);
    gl->BindBuffer(GL_ARRAY_BUFFER, m->vertices);
    gl->GenBuffers(1, &m->indices);
    for (GLuint i = 0; i < 4; i++) {
        gl->EnableVertexAttribArray(i);
        gl->VertexAttribPointer(i, attribute[i].numbers, GL_FLOAT, GL_FALSE,
                                sizeof(struct relume_mesh_vertex),
                                (const void *)attribute[i].offset);
    }
    create_tints(m, info);
    upload_surface(m, info);
}

void object_mesh_destroy(struct object_mesh *m)
{
    if (!m->gl)
        return;
    m->gl->DeleteVertexArrays(1, &m->array);
    m->gl->DeleteBuffers(1, &m->vertices);
    m->gl->DeleteBuffers(1, &m->indices);
    m->gl->DeleteBuffers(1, &m->tints);
    relume_objects_destroy(&m->seen);
    *m = (struct object_mesh){.gl = NULL};
}

const struct relume_objects_info *object_mesh_drawn(const struct object_mesh *m,
                                                    const relume_objects *objects)
{
    return relume_objects_info(m->seen ? m->seen : objects);
}

relume_status object_mesh_see(struct object_mesh *m, const relume_objects *objects,
                              const struct frame_projection *projection,
                              const struct relume_log *log)
{
    const relume_objects *before = m->seen;
    const float *e = projection->eye;
    const struct relume_vec3 eye = {(double)e[0], (double)e[1], (double)e[2]};
    GLint array = 0;
    const relume_status status =
        relume_objects_shown(&m->seen, objects, eye, projection->pixel, false);
    if (status || m->seen == before)
        return status;
    m->gl->GetIntegerv(GL_VERTEX_ARRAY_BINDING, &array);
    m->gl->BindVertexArray(m->array);
    upload_surface(m, object_mesh_drawn(m, objects));
    m->gl->BindVertexArray((GLuint)array);
    return gl_check(m->gl, "uploading objects", log);
}

void object_mesh_draw(const struct object_mesh *m, size_t first, size_t count)
{
    m->gl->DrawElements(GL_TRIANGLES, (GLsizei)(3 * count), GL_UNSIGNED_INT,
                        (const void *)(3 * first * sizeof(uint32_t)));
}
