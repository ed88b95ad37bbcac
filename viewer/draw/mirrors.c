// mirrors.c - mirrors among objects, on the GPU. Twin: src/object/mirror.c
#include "draw/mirrors.h"

#include "relit/light_uniforms.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    VIEW = DRAW_OWN,
    ELEVATION,
    DISC,
    PLACE,
    NORMAL,
    PLACES,
    HAS_PLACES,
    CENTRE,
    PART,
    EYE,
    FROZEN,
    REFLECTANCE,
    TURN,
    TINT,
    EDIT,
    EDIT_SETS,
    EDIT_LEAST,
    COUNT
};
static const char *const uniforms[] = {
    "rectangle", "frame_size", "view",   "elevation", "disc",       "place",  "normal_s",
    "places",    "has_places", "centre", "part",      "eye",        "frozen", "reflectance",
    "turn",      "tint",       "edit",   "edit_sets", "edit_least",
};
enum { UNIT_VIEW, UNIT_PLACE, UNIT_NORMAL, UNIT_PLACES, UNIT_EDIT };

void mirrors_forget(struct mirrors *m)
{
    if (!m->gl)
        return;
    program_destroy(&m->sphere, m->gl);
    program_destroy(&m->panorama, m->gl);
    for (int i = 0; i < m->skies; i++)
        m->gl->DeleteTextures(1, &m->sky[i].texture);
    m->gl->DeleteTextures(1, &m->edit);
    m->gl->DeleteBuffers(1, &m->edit_buffer);
    free(m->sky);
    *m = (struct mirrors){.gl = m->gl, .log = m->log};
}

static relume_status need_program(struct program *program, const struct mirrors *m,
                                  const struct relume_geometry *geometry)
{
    return program->id ? RELUME_OK
                       : program_create_variant(program, m->gl, draw_panorama_shader(geometry),
                                                "#define MIRROR\n", uniforms, COUNT, m->log);
}

static relume_status find_sky(GLuint *out, struct mirrors *m, const relume_environment *e)
{
    for (int i = 0; i < m->skies; i++)
        if (m->sky[i].of == e) {
            *out = m->sky[i].texture;
            return RELUME_OK;
        }
    struct mirror_sky *more = realloc(m->sky, ((size_t)m->skies + 1) * sizeof *more);
    if (!more)
        return RELUME_ENOMEM;
    const struct relume_image *map = relume_environment_map(e);
    m->sky = more;
    more[m->skies].of = e;
    m->gl->GenTextures(1, &more[m->skies].texture);
    *out = more[m->skies].texture;
    light_uniforms_upload(m->gl, UNIT_VIEW, *out, GL_RGB32F, GL_RGB, map->width, map->height,
                          map->data);
    m->skies++;
    return gl_check(m->gl, "uploading an environment", m->log);
}

// ---------------------------------------------------------------- edits

static void put(float *to, struct relume_vec3 v, double last)
{
    to[0] = (float)v.x, to[1] = (float)v.y, to[2] = (float)v.z, to[3] = (float)last;
}

static int sets_of(const struct relume_reflection_edit *e)
{
    return e->regions ? e->regions : 1;
}

static size_t texels_of(const relume_reflection *reflection)
{
    const struct relume_reflection_edit *e = relume_reflection_edit(reflection);
    size_t n = 0;
    double least;
    for (int i = 0; i < sets_of(e); i++)
        n += 2 + 3 * (size_t)relume_reflection_set_of(&least, reflection, i).members +
             (e->regions ? (size_t)e->region[i].points : 0);
    return n;
}

// As reflection.glsl.
static void fill(float (*to)[4], const relume_reflection *reflection)
{
    const struct relume_reflection_edit *e = relume_reflection_edit(reflection);
    int at = 2 * sets_of(e);
    double least;
    for (int i = 0; i < sets_of(e); i++) {
        const struct relume_reflection_set set = relume_reflection_set_of(&least, reflection, i);
        const struct relume_reflection_region everywhere = {.points = -1};
        const struct relume_reflection_region *g = e->regions ? &e->region[i] : &everywhere;
        put(to[2 * i], g->centre, g->radius);
        put(to[2 * i + 1], (struct relume_vec3){g->border, g->points, at}, set.members);
        for (int k = 0; k < set.members; k++) {
            const struct relume_reflection_constraint *c = &e->constraint[set.member[k]];
            put(to[at++], c->position, 0.0);
            put(to[at++], c->original, 0.0);
            put(to[at++], c->edited, 0.0);
        }
        for (int k = 0; k < g->points; k++)
            put(to[at++], g->stroke[k], 0.0);
    }
}

// Said once: what GL does otherwise.
static void say_straight(struct mirrors *m, const struct relume_reflection_edit *e)
{
    bool along = e->geodesic;
    for (int i = 0; i < e->regions; i++)
        along |= e->region[i].shape == RELUME_REFLECTION_GEODESIC;
    if (along && !m->said && m->log && m->log->message)
        m->log->message(m->log->user, RELUME_WARNING,
                        "reflections: the viewer takes distances along the surface as straight "
                        "ones; 'relume relight' shows them as they are");
    m->said |= along;
}

static relume_status use_edit(struct mirrors *m, const GLint *at,
                              const relume_reflection *reflection)
{
    const struct gl *gl = m->gl;
    const struct relume_reflection_edit *e = reflection ? relume_reflection_edit(reflection) : NULL;
    const size_t texels = reflection ? texels_of(reflection) : 1;
    float(*data)[4] = calloc(texels, sizeof *data);
    double least = 1.0;
    if (!data)
        return RELUME_ENOMEM;
    if (reflection) {
        say_straight(m, e);
        fill(data, reflection);
        (void)relume_reflection_set_of(&least, reflection, 0);
    }
    if (!m->edit) {
        gl->GenBuffers(1, &m->edit_buffer);
        gl->GenTextures(1, &m->edit);
    }
    gl->BindBuffer(GL_TEXTURE_BUFFER, m->edit_buffer);
    gl->BufferData(GL_TEXTURE_BUFFER, (GLsizeiptr)(texels * sizeof *data), data, GL_STATIC_DRAW);
    texture_use(gl, UNIT_EDIT, GL_TEXTURE_BUFFER, m->edit);
    gl->TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, m->edit_buffer);
    gl->Uniform1i(at[EDIT], UNIT_EDIT);
    gl->Uniform1i(at[EDIT_SETS], e ? sets_of(e) : 0);
    gl->Uniform1f(at[EDIT_LEAST], (float)least);
    gl->Uniform4f(at[FROZEN], e ? (float)e->eye.x : 0.0f, e ? (float)e->eye.y : 0.0f,
                  e ? (float)e->eye.z : 0.0f, e && e->frozen ? 1.0f : 0.0f);
    free(data);
    return gl_check(gl, "edited reflections", m->log);
}

// ---------------------------------------------------------------- passes

static void use_surface(const struct mirrors *m, const GLint *at,
                        const struct mirror_surface *surface, int part, const float reflectance[3])
{
    const struct gl *gl = m->gl;
    texture_use(gl, UNIT_PLACE, GL_TEXTURE_2D, surface->place->texture);
    texture_use(gl, UNIT_NORMAL, GL_TEXTURE_2D, surface->normal->texture);
    gl->Uniform1i(at[VIEW], UNIT_VIEW);
    gl->Uniform1i(at[PLACE], UNIT_PLACE);
    gl->Uniform1i(at[NORMAL], UNIT_NORMAL);
    gl->Uniform1i(at[PLACES], UNIT_PLACES);
    gl->Uniform1i(at[PART], part);
    gl->Uniform4f(at[EYE], surface->eye[0], surface->eye[1], surface->eye[2], surface->eye[3]);
    gl->Uniform3f(at[REFLECTANCE], reflectance[0], reflectance[1], reflectance[2]);
}

static void draw(const struct mirrors *m, const struct program *program,
                 const struct mirror_surface *surface)
{
    const struct place whole = {.width = surface->place->width, .height = surface->place->height};
    m->gl->Enable(GL_BLEND);
    m->gl->BlendFunc(GL_ONE, GL_ONE);
    draw_rectangle(m->gl, program, &whole, (struct app_rectangle){0, 0, whole.width, whole.height});
    m->gl->Disable(GL_BLEND);
}

static void draw_in_panorama(const struct mirrors *m, const struct mirror_surface *surface,
                             const struct mirror_panorama *panorama)
{
    const struct gl *gl = m->gl;
    const struct relume_geometry *g = panorama->geometry;
    const GLint *at = m->panorama.at;
    texture_use(gl, UNIT_VIEW, GL_TEXTURE_2D, panorama->view->texture);
    texture_use(gl, UNIT_PLACES, GL_TEXTURE_2D, panorama->places->texture);
    gl->Uniform2f(at[ELEVATION], (float)g->v_min, (float)g->v_max);
    gl->Uniform1i(at[DISC], g->disc);
    gl->Uniform1i(at[HAS_PLACES], true);
    gl_set_vec3(gl, at[CENTRE], g->center);
    gl->Uniform1f(at[TURN], 0.0f);
    gl->Uniform3f(at[TINT], 1.0f, 1.0f, 1.0f);
    draw(m, &m->panorama, surface);
}

static relume_status draw_skies(struct mirrors *m, const struct mirror_surface *surface,
                                const struct relume_light *lights, int n)
{
    const struct gl *gl = m->gl;
    const GLint *at = m->sphere.at;
    relume_status status = RELUME_OK;
    for (int i = 0; i < n && !status; i++) {
        GLuint texture;
        if (lights[i].kind != RELUME_LIGHT_ENVIRONMENT)
            continue;
        status = find_sky(&texture, m, lights[i].environment);
        if (status)
            break;
        texture_use(gl, UNIT_VIEW, GL_TEXTURE_2D, texture);
        gl->Uniform1i(at[HAS_PLACES], false);
        gl->Uniform1f(at[TURN], (float)(-lights[i].rotate_deg * (M_PI / 180.0)));
        gl->Uniform3f(at[TINT], lights[i].rgb[0], lights[i].rgb[1], lights[i].rgb[2]);
        draw(m, &m->sphere, surface);
    }
    return status;
}

relume_status mirrors_draw(struct mirrors *m, const relume_objects *objects, int part, int material,
                           const struct mirror_surface *surface,
                           const struct mirror_panorama *panorama,
                           const struct relume_light *lights, int n)
{
    static const struct relume_geometry sphere = {.projection = RELUME_SPHERICAL};
    const struct relume_objects_info *info = relume_objects_info(objects);
    const bool around = panorama->geometry;
    struct program *program = around ? &m->panorama : &m->sphere;
    relume_status status = need_program(program, m, around ? panorama->geometry : &sphere);
    if (status)
        return status;
    m->gl->UseProgram(program->id);
    use_surface(m, program->at, surface, part, info->material[material].reflectance);
    status = use_edit(m, program->at, relume_objects_reflections(objects, info->part[part].object));
    if (status)
        return status;
    if (!around)
        return draw_skies(m, surface, lights, n);
    draw_in_panorama(m, surface, panorama);
    return RELUME_OK;
}
