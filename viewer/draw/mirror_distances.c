// mirror_distances.c - distances along the surface of edited reflections, on the GPU
#include "draw/mirror_distances.h"

#include "gl/target.h"
#include "world/object/drawn_objects.h"
#include "world/reflect/reflection.h"

#include <math.h>
#include <stdlib.h>

_Static_assert(sizeof(struct relume_mesh_vertex) == 12 * sizeof(float),
               "mirror.glsl reads a vertex as three texels");

// What shaders take for infinite: its square in thousandths of the surface's size is a number yet.
static const float NEVER = 1e15f;

void mirror_distances_forget(struct mirror_distances *d, const struct gl *gl)
{
    for (int i = 0; i < d->objects; i++) {
        gl->DeleteTextures(1, &d->object[i].texture);
        gl->DeleteBuffers(1, &d->object[i].buffer);
    }
    gl->DeleteTextures(1, &d->vertices);
    gl->DeleteTextures(1, &d->triangles);
    free(d->object);
    *d = (struct mirror_distances){0};
}

// ---------------------------------------------------------------- fields

static int fields_before(const relume_reflection *r, int constraints, int regions)
{
    int n = 0;
    for (int i = 0; i < constraints; i++)
        n += relume_reflection_from_constraint(r, i) != NULL;
    for (int i = 0; i < regions; i++)
        n += relume_reflection_from_region(r, i) != NULL;
    return n;
}

int mirror_field_of_constraint(const relume_reflection *r, int constraint)
{
    return relume_reflection_from_constraint(r, constraint) ? fields_before(r, constraint, 0) : -1;
}

int mirror_field_of_region(const relume_reflection *r, int region)
{
    return relume_reflection_from_region(r, region)
               ? fields_before(r, relume_reflection_edit(r)->constraints, region)
               : -1;
}

static float *put_field(float *to, const float *distance, size_t vertices)
{
    for (size_t i = 0; distance && i < vertices; i++)
        *to++ = fminf(distance[i], NEVER);
    return to;
}

static relume_status upload(struct mirror_fields *f, const struct gl *gl,
                            const relume_reflection *r, size_t vertices)
{
    const struct relume_reflection_edit *e = relume_reflection_edit(r);
    const size_t bytes = (size_t)f->count * vertices * sizeof(float);
    float *data = malloc(bytes), *at = data;
    if (!data)
        return RELUME_ENOMEM;
    for (int i = 0; i < e->constraints; i++)
        at = put_field(at, relume_reflection_from_constraint(r, i), vertices);
    for (int i = 0; i < e->regions; i++)
        at = put_field(at, relume_reflection_from_region(r, i), vertices);
    if (!f->buffer) {
        gl->GenBuffers(1, &f->buffer);
        gl->GenTextures(1, &f->texture);
    }
    gl->BindBuffer(GL_TEXTURE_BUFFER, f->buffer);
    gl->BufferData(GL_TEXTURE_BUFFER, (GLsizeiptr)bytes, data, GL_STATIC_DRAW);
    free(data);
    return RELUME_OK;
}

static bool fits(const struct gl *gl, const struct relume_objects_info *info, int fields)
{
    const size_t numbers[] = {3 * info->vertex_count, 3 * info->triangle_count,
                              (size_t)fields * info->vertex_count};
    const size_t EXACT = 1 << 24;  // whole numbers up to here are so in single precision
    GLint most = 0;
    gl->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (numbers[i] > (size_t)most)
            return false;
    return info->triangle_count < EXACT;
}

static relume_status need_fields(struct mirror_fields *f, struct mirror_distances *d,
                                 const struct gl *gl, const struct relume_objects_info *info,
                                 const relume_reflection *r)
{
    if (f->made && f->of == info->reflections_set)
        return RELUME_OK;
    const struct relume_reflection_edit *e = relume_reflection_edit(r);
    f->of = info->reflections_set;
    f->count = fields_before(r, e->constraints, e->regions);
    if (f->count && !fits(gl, info, f->count)) {
        d->too_large = true;
        f->count = 0;
    }
    const relume_status status = f->count ? upload(f, gl, r, info->vertex_count) : RELUME_OK;
    f->made = !status;
    return status;
}

// ---------------------------------------------------------------- use

static void use_buffer(const struct gl *gl, int unit, GLuint *texture, GLenum format, GLuint buffer)
{
    if (!*texture)
        gl->GenTextures(1, texture);
    texture_use(gl, unit, GL_TEXTURE_BUFFER, *texture);
    gl->TexBuffer(GL_TEXTURE_BUFFER, format, buffer);
}

relume_status mirror_distances_use(int *count, struct mirror_distances *d, const struct gl *gl,
                                   const relume_objects *objects, int object, GLuint vertices,
                                   GLuint triangles, const struct mirror_units *units,
                                   const struct relume_log *log)
{
    const struct relume_objects_info *info = relume_objects_info(objects);
    const relume_reflection *r = relume_objects_reflections(objects, object);
    *count = 0;
    if (!d->object)
        d->object = calloc((size_t)info->objects, sizeof *d->object);
    if (!d->object)
        return RELUME_ENOMEM;
    d->objects = info->objects;
    struct mirror_fields *f = &d->object[object];
    const relume_status status = r ? need_fields(f, d, gl, info, r) : RELUME_OK;
    if (status || !r || !f->count)
        return status;
    *count = f->count;
    use_buffer(gl, units->along, &f->texture, GL_R32F, f->buffer);
    use_buffer(gl, units->vertices, &d->vertices, GL_RGBA32F, vertices);
    use_buffer(gl, units->triangles, &d->triangles, GL_R32UI, triangles);
    return gl_check(gl, "distances along mirrors", log);
}
