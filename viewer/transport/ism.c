// ism.c - light gathered from virtual lights with imperfect shadow maps, by compute shaders
#include "transport/ism.h"

#include "cli/program/say.h"
#include "world/object/object_points.h"

#include <math.h>
#include <stdio.h>

// As instant.c has it: maps of 64 x 64, smaller ones where there are many; a map draws a point for
// so many of its texels.
enum { USUAL = 64, LEAST = 8, ATLAS = 4096 * 4096 / 4 * 5, ATLAS_WIDE = 4096, POINTS = 4 };
enum { TEXELS_OF_LIGHT = 4 };

enum { PLACE, FACING, ROOT, LEAF_OF, RANGE, AGAIN, CENTRE, OFF, LIGHTS_OBJECTS, LIGHTS_COUNT };
static const char *const lights_uniforms[] = {"place", "facing", "root", "leaf_of", "range",
                                              "again", "centre", "off",  "objects"};
enum { MAPS_LIGHT, SPOT, SPOTS, AREA, FIRST_MAP, AT_OBJECTS, MAPS_OBJECTS, MAPS_COUNT };
static const char *const maps_uniforms[] = {"light", "spot",       "spots",  "area",
                                            "first", "at_objects", "objects"};
enum {
    LIGHT,
    OF_SCENE,
    OF_OBJECTS,
    SQUARE,
    FIRST,
    LIGHTS,
    PATTERN,
    BALL,
    SITE,
    GATHER_COUNT = SITE + SITE_UNIFORMS
};
static const char *const gather_uniforms[] = {"light",   "of_scene", "of_objects",
                                              "square",  "first",    "lights",
                                              "pattern", "objects",  SITE_NAMES};

relume_status ism_create(struct ism *s, const struct gl *gl, const struct relume_log *log)
{
    *s = (struct ism){.gl = gl, .log = log};
    const relume_status status = program_create_compute(&s->lights, gl, "transport_lights.comp",
                                                        NULL, lights_uniforms, LIGHTS_COUNT, log);
    if (status)
        ism_destroy(s);
    return status;
}

static void release_lights(struct ism *s)
{
    s->gl->DeleteBuffers(1, &s->light);
    s->gl->DeleteTextures(1, &s->light_texels);
    s->gl->DeleteTextures(2, s->atlas);
    s->light = s->light_texels = s->atlas[0] = s->atlas[1] = 0;
    s->capacity = 0;
}

void ism_destroy(struct ism *s)
{
    struct program *const programs[] = {&s->lights, &s->maps, &s->gather};
    if (!s->gl)
        return;
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        program_destroy(programs[i], s->gl);
    release_lights(s);
    *s = (struct ism){.gl = NULL};
}

// ---------------------------------------------------------------- memory

static int on_scene_of(int samples)
{
    return ISM_PATTERN * ISM_PATTERN * samples;
}

static int on_objects_of(int samples)
{
    return ISM_PATTERN * ISM_PATTERN * (samples / 4 ? samples / 4 : 1);
}

static relume_status need_programs(struct ism *s, int size)
{
    char defines[32];
    if (s->size == size)
        return RELUME_OK;
    program_destroy(&s->maps, s->gl);
    program_destroy(&s->gather, s->gl);
    snprintf(defines, sizeof defines, "#define SIZE %d\n", size);
    relume_status status = program_create_compute(&s->maps, s->gl, "transport_maps.comp", defines,
                                                  maps_uniforms, MAPS_COUNT, s->log);
    if (!status)
        status = program_create_compute(&s->gather, s->gl, "transport_ism.comp", defines,
                                        gather_uniforms, GATHER_COUNT, s->log);
    s->size = status ? 0 : size;
    return status;
}

static GLuint make_atlas(const struct ism *s, int rows)
{
    const struct gl *gl = s->gl;
    GLuint texture;
    gl->GenTextures(1, &texture);
    texture_use(gl, 0, GL_TEXTURE_2D, texture);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_R32F, ATLAS_WIDE, rows, 0, GL_RED, GL_FLOAT, NULL);
    texture_settings(gl, GL_TEXTURE_2D);
    return texture;
}

relume_status ism_need(struct ism *s, int samples)
{
    const struct gl *gl = s->gl;
    const int64_t lights = (int64_t)ISM_PATTERN * ISM_PATTERN * (samples + samples / 4 + 1);
    int size = USUAL;
    while (size > LEAST && lights * size * size > ATLAS)
        size /= 2;
    const int64_t across = ATLAS_WIDE / size, rows = (lights + across - 1) / across * size;
    if (lights * size * size > ATLAS || rows > gl->max_texture || gl->max_texture < ATLAS_WIDE ||
        lights * TEXELS_OF_LIGHT > gl->max_buffer)
        return say(s->log, RELUME_ESYSTEM,
                   "%d samples are %lld virtual lights, whose shadow maps do not fit into the "
                   "textures of OpenGL here",
                   samples, (long long)lights);
    const bool other = s->size != size;
    const relume_status status = need_programs(s, size);
    if (status || (!other && s->capacity >= lights))
        return status;
    release_lights(s);
    s->light = gl_storage(gl, (size_t)lights * TEXELS_OF_LIGHT * 4 * sizeof(float), NULL);
    gl->GenTextures(1, &s->light_texels);
    texture_use(gl, 0, GL_TEXTURE_BUFFER, s->light_texels);
    gl->TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, s->light);
    for (int i = 0; i < 2; i++)
        s->atlas[i] = make_atlas(s, (int)rows);
    s->capacity = (int)lights;
    return gl_check(gl, "shadow maps of virtual lights", s->log);
}

// ---------------------------------------------------------------- lights

static void use_ball(const struct gl *gl, GLint at, const struct points_view *v)
{
    gl->Uniform4f(at, (float)v->middle.x, (float)v->middle.y, (float)v->middle.z, (float)v->radius);
}

static void use_texels(const struct gl *gl, GLint at, int unit, GLuint texture)
{
    texture_use(gl, unit, GL_TEXTURE_BUFFER, texture);
    gl->Uniform1i(at, unit);
}

// The number of a leaf of a tree among all, less its node's.
static int leaf_less_node(const struct card_points *c, int tree)
{
    const struct relume_points *p = &c->tree[tree];
    int before = 0;
    for (int i = 0; i < tree; i++)
        before += (int)c->tree[i].leaves;
    return p->levels ? before - c->first[tree] - (int)p->first[p->levels - 1] : 0;
}

// From two trees, or one, named twice; `again`: they are those that were drawn before.
static void draw_lights(const struct ism *s, const struct points_view *v, const int tree[2],
                        int first, int count, bool again)
{
    enum { AT_ONCE = 64 };
    const double DEPTH = 0.005, SURFACE = 1e-4;  // as points_use_sites
    const struct gl *gl = s->gl;
    const GLint *at = s->lights.at;
    const struct card_points *c = v->points;
    const bool of_scene = tree[0] == CARD_SCENE, two = tree[1] != tree[0];
    gl->UseProgram(s->lights.id);
    gl_bind(gl, 0, c->node);
    gl_bind(gl, 1, c->sent);
    gl_bind(gl, 2, s->light);
    texture_use(gl, 0, GL_TEXTURE_2D, c->leaf_place.texture);
    gl->Uniform1i(at[PLACE], 0);
    texture_use(gl, 1, GL_TEXTURE_2D, c->leaf_facing.texture);
    gl->Uniform1i(at[FACING], 1);
    gl->Uniform2i(at[ROOT], c->first[tree[0]], two ? c->first[tree[1]] : -1);
    gl->Uniform2i(at[LEAF_OF], leaf_less_node(c, tree[0]), leaf_less_node(c, tree[1]));
    gl->Uniform2i(at[RANGE], first, count);
    gl->Uniform1i(at[AGAIN], again);
    gl->Uniform4f(at[CENTRE], (float)v->centre.x, (float)v->centre.y, (float)v->centre.z,
                  of_scene ? (float)DEPTH : 0.0f);
    gl->Uniform1f(at[OFF], of_scene ? 0.0f : (float)(SURFACE * v->radius));
    gl->DispatchCompute((GLuint)((count + AT_ONCE - 1) / AT_ONCE), 1, 1);
    points_wait(gl);
}

// Of the scene's surfaces, or of the objects', as many as a map draws of them.
static int run_of(const struct ism *s, const struct relume_points *p)
{
    const int run = s->size * s->size / POINTS;
    return (size_t)run < p->spots ? run : (int)p->spots;
}

static float area_of(const struct ism *s, const struct relume_points *p)
{
    return p->spots ? (float)(p->area * (double)p->spots / run_of(s, p)) : 0.0f;
}

static void draw_maps(const struct ism *s, const struct points_view *v, int first, int count)
{
    enum { AT_ONCE = 65535 };  // work groups, that any OpenGL has
    const struct gl *gl = s->gl;
    const GLint *at = s->maps.at;
    gl->UseProgram(s->maps.id);
    use_texels(gl, at[MAPS_LIGHT], 0, s->light_texels);
    use_ball(gl, at[MAPS_OBJECTS], v);
    for (int i = 0; i < 2; i++) {
        const struct relume_points *p = &v->points->tree[i ? CARD_OBJECTS : CARD_SCENE];
        use_texels(gl, at[SPOT], 1, v->points->spot_texels[i]);
        gl->Uniform2i(at[SPOTS], (int)p->spots, run_of(s, p));
        gl->Uniform1f(at[AREA], area_of(s, p));
        gl->Uniform1i(at[AT_OBJECTS], i);
        gl->BindImageTexture(0, s->atlas[i], 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32F);
        for (int done = 0; done < count; done += AT_ONCE) {
            gl->Uniform1i(at[FIRST_MAP], first + done);
            gl->DispatchCompute((GLuint)(count - done < AT_ONCE ? count - done : AT_ONCE), 1, 1);
        }
    }
    points_wait(gl);
}

// ---------------------------------------------------------------- gathering

// Sites from row `top` on; `pattern` 0: they are leaves.
static void draw_gathered(const struct ism *s, const struct points_view *v,
                          const struct points_sites *sites, int top, int pattern)
{
    enum { AT_ONCE = 8 };
    const struct gl *gl = s->gl;
    const GLint *at = s->gather.at;
    gl->UseProgram(s->gather.id);
    points_use_sites(gl, at + SITE, v, sites);
    use_texels(gl, at[LIGHT], 2, s->light_texels);
    for (int i = 0; i < 2; i++) {
        texture_use(gl, 3 + i, GL_TEXTURE_2D, s->atlas[i]);
        gl->Uniform1i(at[OF_SCENE + i], 3 + i);
    }
    gl->Uniform2f(at[SQUARE], sqrtf(area_of(s, &v->points->tree[CARD_SCENE])),
                  sqrtf(area_of(s, &v->points->tree[CARD_OBJECTS])));
    gl->Uniform2i(at[FIRST], 0, top);
    gl->Uniform2i(at[LIGHTS], s->on_scene, s->all);
    gl->Uniform1i(at[PATTERN], pattern);
    use_ball(gl, at[BALL], v);
    gl->DispatchCompute((GLuint)((sites->place->width + AT_ONCE - 1) / AT_ONCE),
                        (GLuint)((sites->place->height - top + AT_ONCE - 1) / AT_ONCE), 1);
    points_wait(gl);
}

void ism_gather(const struct ism *s, const struct points_view *v, const struct points_sites *sites)
{
    draw_gathered(s, v, sites, 0, ISM_PATTERN);
}

relume_status ism_light(struct ism *s, struct point_light *light, const struct points_view *v,
                        const struct points_lit *lit)
{
    static const int scene[] = {CARD_SCENE, CARD_SCENE}, objects[] = {CARD_OBJECTS, CARD_BACKS};
    const int count = on_objects_of(v->samples);
    relume_status status = ism_need(s, v->samples);
    if (!status)
        status = point_light_scene(light, v, lit);
    if (status)
        return status;
    s->on_scene = s->all = on_scene_of(v->samples);
    draw_lights(s, v, scene, 0, s->on_scene, false);
    draw_maps(s, v, 0, s->on_scene);
    for (int i = 0; i < v->bounces; i++) {
        int top;
        const struct points_sites sites = point_light_sites(&top, light, v);
        draw_gathered(s, v, &sites, top, 0);
        point_light_objects(light, v, lit);
        draw_lights(s, v, objects, s->on_scene, count, i > 0);
        if (i == 0)
            draw_maps(s, v, s->on_scene, count);
        s->all = s->on_scene + count;
    }
    return gl_check(s->gl, "virtual lights", s->log);
}
