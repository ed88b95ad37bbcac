// object_surface.c - the surface of objects in a frame: textures of positions and frames
#include "draw/object_surface.h"

#include "cli/program/say.h"

enum { FINER = 2 };  // grid; where OpenGL is software 1

// The last ones only where the surface is coloured.
enum { TARGETS = 6, PLAIN = 4 };
static void list_targets(struct target *out[TARGETS], struct object_surface *s)
{
    struct target *const all[TARGETS] = {&s->position,  &s->normal, &s->tangent,
                                         &s->footprint, &s->tint,   &s->emitted};
    for (int i = 0; i < TARGETS; i++)
        out[i] = all[i];
}

relume_status object_surface_create(struct object_surface *s, const struct gl *gl,
                                    const struct relume_log *log)
{
    *s = (struct object_surface){.grid = gl->software ? 1 : FINER};
    return object_parts_program(&s->program, gl, "btf_surface.frag", log);
}

static void destroy_targets(struct object_surface *s, const struct gl *gl)
{
    struct target *target[TARGETS];
    list_targets(target, s);
    for (int i = 0; i < TARGETS; i++)
        target_destroy(target[i], gl);
    gl->DeleteFramebuffers(1, &s->framebuffer);
    gl->DeleteTextures(1, &s->depth);
    s->framebuffer = s->depth = 0;
}

void object_surface_destroy(struct object_surface *s, const struct gl *gl)
{
    program_destroy(&s->program, gl);
    destroy_targets(s, gl);
}

relume_status object_surface_join(GLuint *out, const struct gl *gl,
                                  const struct target *const *target, int n, GLuint depth,
                                  const struct relume_log *log)
{
    return target_join(out, gl, target, n, depth)
               ? gl_check(gl, "objects", log)
               : say(log, RELUME_ESYSTEM, "OpenGL: cannot draw the surface of objects");
}

static void create_depth(struct object_surface *s, const struct gl *gl, int width, int height)
{
    gl->GenTextures(1, &s->depth);
    texture_use(gl, 0, GL_TEXTURE_2D, s->depth);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, width, height, 0, GL_DEPTH_COMPONENT,
                   GL_FLOAT, NULL);
    texture_settings(gl, GL_TEXTURE_2D);
}

relume_status object_surface_need(struct object_surface *s, const struct gl *gl, int width,
                                  int height, bool coloured, const struct relume_log *log)
{
    struct target *target[TARGETS];
    const int n = coloured ? TARGETS : PLAIN;
    relume_status status = RELUME_OK;
    width *= s->grid, height *= s->grid;
    if (s->framebuffer && s->position.width == width && s->position.height == height)
        return RELUME_OK;
    destroy_targets(s, gl);
    list_targets(target, s);
    for (int i = 0; !status && i < n; i++)
        status = target_create(target[i], gl, width, height, log);
    if (!status) {
        create_depth(s, gl, width, height);
        status = object_surface_join(&s->framebuffer, gl, (const struct target *const *)target, n,
                                     s->depth, log);
    }
    if (status)
        destroy_targets(s, gl);
    return status;
}

void object_surface_draw(const struct object_surface *s, const struct object_parts *parts,
                         const struct frame_projection *projection)
{
    const struct gl *gl = parts->mesh->gl;
    GLint before = 0;
    gl->GetIntegerv(GL_VERTEX_ARRAY_BINDING, &before);
    gl->BindVertexArray(parts->mesh->array);
    gl->BindFramebuffer(GL_FRAMEBUFFER, s->framebuffer);
    gl->Viewport(0, 0, s->position.width, s->position.height);
    gl->ClearColor(0, 0, 0, 0);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl->Enable(GL_DEPTH_TEST);
    gl->UseProgram(s->program.id);
    gl->UniformMatrix4fv(s->program.at[SURFACE_CLIP], 1, GL_FALSE, projection->clip);
    object_parts_draw(parts, &s->program);
    gl->Disable(GL_DEPTH_TEST);
    gl->BindVertexArray((GLuint)before);
}
