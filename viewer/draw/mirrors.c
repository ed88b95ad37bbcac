// mirrors.c - mirrors among objects, on the GPU. Twin: src/world/object/mirror.c
#include "draw/mirrors.h"

#include "relight/light/environment.h"
#include "relit/light_uniforms.h"
#include "world/object/drawn_objects.h"
#include "world/reflect/reflection.h"

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
    TRIANGLE,
    VERTICES,
    TRIANGLES,
    ALONG,
    ALONG_VERTICES,
    ALONG_EDGE,
    COUNT
};
static const char *const uniforms[] = {
    "rectangle", "frame_size", "view",      "elevation",      "disc",
    "place",     "normal_s",   "places",    "has_places",     "centre",
    "part",      "eye",        "frozen",    "reflectance",    "turn",
    "tint",      "edit",       "edit_sets", "edit_least",     "triangle",
    "vertices",  "triangles",  "along",     "along_vertices", "along_edge",
};
enum {
    UNIT_VIEW,
    UNIT_PLACE,
    UNIT_NORMAL,
    UNIT_PLACES,
    UNIT_EDIT,
    UNIT_TRIANGLE,
    UNIT_VERTICES,
    UNIT_TRIANGLES,
    UNIT_ALONG
};

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
    mirror_distances_forget(&m->distances, m->gl);
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
    const uint64_t of = relume_environment_fingerprint(e);
    for (int i = 0; i < m->skies; i++)
        if (m->sky[i].of == of) {
            *out = m->sky[i].texture;
            return RELUME_OK;
        }
    struct mirror_sky *more = realloc(m->sky, ((size_t)m->skies + 1) * sizeof *more);
    if (!more)
        return RELUME_ENOMEM;
    const struct relume_image *map = relume_environment_map(e);
    m->sky = more;
    more[m->skies].of = of;
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

// What stands for the points of a stroke in a region that goes along the surface.
static int points_of(const relume_reflection *reflection, int region, bool along)
{
    const struct relume_reflection_edit *e = relume_reflection_edit(reflection);
    const int field = along && e->regions ? mirror_field_of_region(reflection, region) : -1;
    return field >= 0 ? -2 - field : e->regions ? e->region[region].points : -1;
}

// As reflection.glsl; `along`: fields of distances are there.
static void fill(float (*to)[4], const relume_reflection *reflection, bool along)
{
    const struct relume_reflection_edit *e = relume_reflection_edit(reflection);
    int at = 2 * sets_of(e);
    double least;
    for (int i = 0; i < sets_of(e); i++) {
        const struct relume_reflection_set set = relume_reflection_set_of(&least, reflection, i);
        const struct relume_reflection_region everywhere = {.points = 0};
        const struct relume_reflection_region *g = e->regions ? &e->region[i] : &everywhere;
        put(to[2 * i], g->centre, g->radius);
        put(to[2 * i + 1], (struct relume_vec3){g->border, points_of(reflection, i, along), at},
            set.members);
        for (int k = 0; k < set.members; k++) {
            const struct relume_reflection_constraint *c = &e->constraint[set.member[k]];
            put(to[at++], c->position,
                along ? mirror_field_of_constraint(reflection, set.member[k]) : -1);
            put(to[at++], c->original, 0.0);
            put(to[at++], c->edited, 0.0);
        }
        for (int k = 0; k < g->points; k++)
            put(to[at++], g->stroke[k], 0.0);
    }
}

// Said once: what this machine does otherwise.
static void say_straight(struct mirrors *m)
{
    if (m->distances.too_large && !m->said && m->log && m->log->message)
        m->log->message(m->log->user, RELUME_WARNING,
                        "reflections: the mesh is too large for this graphics card; the viewer "
                        "takes distances along the surface as straight ones, 'relume relight' "
                        "shows them as they are");
    m->said |= m->distances.too_large;
}

// The fields that the edit goes along, if this machine holds them.
static relume_status use_distances(int *count, struct mirrors *m, const GLint *at,
                                   const relume_objects *objects, int object,
                                   const struct mirror_surface *surface)
{
    static const struct mirror_units units = {UNIT_ALONG, UNIT_VERTICES, UNIT_TRIANGLES};
    const struct gl *gl = m->gl;
    const struct relume_objects_info *info = relume_objects_info(objects);
    const relume_reflection *r = relume_objects_reflections(objects, object);
    const relume_status status =
        mirror_distances_use(count, &m->distances, gl, objects, object, surface->vertices,
                             surface->triangles, &units, m->log);
    gl->Uniform1i(at[TRIANGLE], UNIT_TRIANGLE);
    gl->Uniform1i(at[VERTICES], UNIT_VERTICES);
    gl->Uniform1i(at[TRIANGLES], UNIT_TRIANGLES);
    gl->Uniform1i(at[ALONG], UNIT_ALONG);
    gl->Uniform1i(at[ALONG_VERTICES], *count ? (GLint)info->vertex_count : 0);
    gl->Uniform1f(at[ALONG_EDGE], r ? (float)relume_reflection_edge(r) : 0.0f);
    texture_use(gl, UNIT_TRIANGLE, GL_TEXTURE_2D, surface->triangle->texture);
    say_straight(m);
    return status;
}

static relume_status use_edit(struct mirrors *m, const GLint *at, const relume_objects *objects,
                              int object, const struct mirror_surface *surface)
{
    const relume_reflection *reflection = relume_objects_reflections(objects, object);
    const struct gl *gl = m->gl;
    const struct relume_reflection_edit *e = reflection ? relume_reflection_edit(reflection) : NULL;
    const size_t texels = reflection ? texels_of(reflection) : 1;
    float(*data)[4] = calloc(texels, sizeof *data);
    double least = 1.0;
    int fields;
    relume_status status =
        data ? use_distances(&fields, m, at, objects, object, surface) : RELUME_ENOMEM;
    if (status) {
        free(data);
        return status;
    }
    if (reflection) {
        fill(data, reflection, fields > 0);
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

// ---------------------------------------------------------------- draws

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

static void draw_mirror(const struct mirrors *m, const struct program *program,
                        const struct mirror_surface *surface)
{
    const struct frame_area whole = {.width = surface->place->width,
                                     .height = surface->place->height};
    m->gl->Enable(GL_BLEND);
    m->gl->BlendFunc(GL_ONE, GL_ONE);
    draw_whole(m->gl, program, &whole);
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
    gl->Uniform1f(at[DISC], (float)g->disc);
    gl->Uniform1i(at[HAS_PLACES], true);
    gl_set_vec3(gl, at[CENTRE], g->center);
    gl->Uniform1f(at[TURN], 0.0f);
    gl->Uniform3f(at[TINT], 1.0f, 1.0f, 1.0f);
    draw_mirror(m, &m->panorama, surface);
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
        draw_mirror(m, &m->sphere, surface);
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
    status = use_edit(m, program->at, objects, info->part[part].object, surface);
    if (status)
        return status;
    if (!around)
        return draw_skies(m, surface, lights, n);
    draw_in_panorama(m, surface, panorama);
    return RELUME_OK;
}
