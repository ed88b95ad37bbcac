// object_parts.c - the parts of objects as triangles of a material each, drawn by programs of
// btf_surface.vert
#include "draw/object_parts.h"

#include "gl/target.h"

static const char *const surface_uniforms[] = {"clip",  "part",   "first", "skin",
                                               "cover", "cutoff", "sends"};

relume_status object_parts_program(struct program *program, const struct gl *gl,
                                   const char *fragment, const struct relume_log *log)
{
    return program_create_with(program, gl, "btf_surface.vert", fragment, surface_uniforms,
                               SURFACE_COUNT, log);
}

int object_parts_material(const struct object_parts *p, int part)
{
    return p->only >= 0 ? p->only : relume_objects_info(p->objects)->part[part].material;
}

static void use_part(const struct object_parts *p, const struct program *program, int part)
{
    const struct gl *gl = p->mesh->gl;
    const GLint *at = program->at;
    const int material = object_parts_material(p, part);
    const struct relume_object_skin *skin =
        relume_objects_info(p->objects)->material[material].skin;
    gl->Uniform1i(at[SURFACE_PART], part);
    gl->Uniform1i(at[SURFACE_SKIN], 0);
    gl->Uniform1i(at[SURFACE_COVER], skin ? (GLint)skin->cover : 0);
    gl->Uniform1i(at[SURFACE_SENDS], skin && skin->sends);
    gl->Uniform1f(at[SURFACE_CUTOFF], skin ? skin->cutoff : 0.0f);
    if (skin)
        texture_use(gl, 0, GL_TEXTURE_2D, p->skins->texture[material]);
}

void object_parts_draw(const struct object_parts *p, const struct program *program)
{
    const struct relume_objects_info *info = object_mesh_drawn(p->mesh, p->objects);
    for (int i = 0; i < info->parts; i++) {
        const struct relume_object_part *part = &info->part[i];
        const bool mirror = info->material[object_parts_material(p, i)].mirror;
        use_part(p, program, i);
        p->mesh->gl->Uniform1i(program->at[SURFACE_FIRST], mirror ? (GLint)part->first : -1);
        object_mesh_draw(p->mesh, part->first, part->count);
    }
}

void object_parts_draw_whole(const struct object_parts *p)
{
    object_mesh_draw(p->mesh, 0, object_mesh_drawn(p->mesh, p->objects)->triangle_count);
}
