// objects_drawer.c - objects covered with measured materials, on the GPU
#include "draw/objects_drawer.h"

#include "cli/program/say.h"
#include "common/vec.h"
#include "draw/objects_drawer_parts.h"

#include <stddef.h>

#include <stdlib.h>
#include <string.h>

static const char *const btf_uniforms[] = {
    "rectangle",
    "frame_size",
    "array0",
    "array1",
    "array2",
    "array3",
    "array4",
    "view_cells",
    "view_triangles",
    "light_cells",
    "light_triangles",
    "place",
    "normal_s",
    "tangent_t",
    "footprint",
    "picture",
    "part",
    "eye",
    "texels",
    "finest",
    "level",
    "levels",
    "bilinear",
    "without_cosine",
    "counts",
    "area",
    "map",
    "map_texels",
    "sky",
    "sky_turn",
    "sky_rgb",
    "sky_table",
    "some_lights",
    "relief",
    "side",
    LIGHT_NAMES,
    SHADOW_NAMES,
};
static const char *const surface_uniforms[] = {"clip",  "part",   "first", "skin",
                                               "cover", "cutoff", "sends"};
enum {
    OVER_PLACE = DRAW_OWN,
    OVER_SHADED,
    OVER_OTHER,
    TINT,
    TINTED,
    DIFFERENCE,
    OVER_SCENE,
    IN_SCENE,
    OVER_RETURNED,
    HAS_RETURNED,
    GRID,
    OVER_EYE,
    EXPOSURE,
    EMITTED,
    OVER_SENDS,
    OVER_COUNT
};
static const char *const over_uniforms[] = {
    "rectangle", "frame_size", "place",    "shaded",   "other",    "tint",
    "tinted",    "difference", "scene",    "in_scene", "returned", "has_returned",
    "grid",      "eye",        "exposure", "emitted",  "sends"};
enum {
    CAST_SCENE = DRAW_OWN,
    CAST_LONE,
    CAST_SAMPLES,
    CAST_OF,
    CAST_SAMPLE,
    CAST_SHADOW,
    CAST_COUNT = CAST_SHADOW + SHADOW_UNIFORMS
};
static const char *const cast_uniforms[] = {"rectangle",    "frame_size",    "scene",
                                            "lone",         "light_samples", "count",
                                            "light_sample", SHADOW_NAMES};

// Where OpenGL is software, a smaller map and no finer grid.
enum { SHADOW_SIDE = 2048, SHADOW_SIDE_SOFTWARE = 1024, FINER = 2 };

// ---------------------------------------------------------------- making

static void fill(const struct gl *gl, GLenum target, GLuint buffer, const void *data, size_t bytes)
{
    gl->BindBuffer(target, buffer);
    gl->BufferData(target, (GLsizeiptr)bytes, data, GL_STATIC_DRAW);
}

// Into the buffers of the vertex array in use.
static void upload_surface(const struct objects_drawer *t, const struct relume_objects_info *info)
{
    fill(t->gl, GL_ARRAY_BUFFER, t->vertices, info->vertices,
         info->vertex_count * sizeof *info->vertices);
    fill(t->gl, GL_ELEMENT_ARRAY_BUFFER, t->indices, info->triangles,
         info->triangle_count * sizeof *info->triangles);
    if (info->tint)
        fill(t->gl, GL_ARRAY_BUFFER, t->tints, info->tint, info->vertex_count * sizeof *info->tint);
}

// Attribute 4.
static void create_tints(struct objects_drawer *t, const struct relume_objects_info *info)
{
    const struct gl *gl = t->gl;
    enum { TINT_AT = 4 };
    if (!info->tint)
        return;
    gl->GenBuffers(1, &t->tints);
    gl->BindBuffer(GL_ARRAY_BUFFER, t->tints);
    gl->EnableVertexAttribArray(TINT_AT);
    gl->VertexAttribPointer(TINT_AT, 3, GL_FLOAT, GL_FALSE, 0, NULL);
}

static void upload_mesh(struct objects_drawer *t, const struct relume_objects_info *info)
{
    const struct gl *gl = t->gl;
    static const struct {
        GLint numbers;
        size_t offset;
    } attribute[] = {{3, offsetof(struct relume_mesh_vertex, position)},
                     {3, offsetof(struct relume_mesh_vertex, normal)},
                     {4, offsetof(struct relume_mesh_vertex, tangent)},
                     {2, offsetof(struct relume_mesh_vertex, texture)}};
    gl->GenVertexArrays(1, &t->array);
    gl->BindVertexArray(t->array);
    gl->GenBuffers(1, &t->vertices);
    gl->BindBuffer(GL_ARRAY_BUFFER, t->vertices);
    gl->GenBuffers(1, &t->indices);
    for (GLuint i = 0; i < 4; i++) {
        gl->EnableVertexAttribArray(i);
        gl->VertexAttribPointer(i, attribute[i].numbers, GL_FLOAT, GL_FALSE,
                                sizeof(struct relume_mesh_vertex),
                                (const void *)attribute[i].offset);
    }
    create_tints(t, info);
    upload_surface(t, info);
}

relume_status objects_drawer_see(struct objects_drawer *t,
                                 const struct frame_projection *projection)
{
    const relume_objects *before = t->seen;
    const float *e = projection->eye;
    const struct relume_vec3 eye = {(double)e[0], (double)e[1], (double)e[2]};
    GLint array = 0;
    const relume_status status =
        relume_objects_shown(&t->seen, t->objects, eye, projection->pixel, false);
    if (status || t->seen == before)
        return status;
    t->gl->GetIntegerv(GL_VERTEX_ARRAY_BINDING, &array);
    t->gl->BindVertexArray(t->array);
    upload_surface(t, objects_drawer_drawn(t));
    t->gl->BindVertexArray((GLuint)array);
    return gl_check(t->gl, "uploading objects", t->log);
}

static relume_status create_programs(struct objects_drawer *t)
{
    const struct gl *gl = t->gl;
    relume_status status =
        program_create_with(&t->surface, gl, "btf_surface.vert", "btf_surface.frag",
                            surface_uniforms, SURFACE_COUNT, t->log);
    if (!status)
        status = program_create_with(&t->depth, gl, "btf_surface.vert", "btf_depth.frag",
                                     surface_uniforms, SURFACE_COUNT, t->log);
    if (!status)
        status = program_create(&t->over, gl, "btf_over.frag", over_uniforms, OVER_COUNT, t->log);
    if (!status)
        status = program_create(&t->cast, gl, "btf_cast.frag", cast_uniforms, CAST_COUNT, t->log);
    return status ? status : objects_drawer_create_sky(t);
}

relume_status objects_drawer_create(struct objects_drawer *t, const struct gl *gl,
                                    relume_objects *objects, const struct relume_log *log)
{
    const struct relume_objects_info *info = relume_objects_info(objects);
    *t = (struct objects_drawer){.gl = gl,
                                 .log = log,
                                 .objects = objects,
                                 .uniforms = {.gl = gl, .log = log},
                                 .maps = {.gl = gl, .log = log},
                                 .mirrors = {.gl = gl, .log = log},
                                 .baked = {.gl = gl, .log = log},
                                 .only = -1,
                                 .grid = gl->software ? 1 : FINER};
    const struct relume_vec3 extent = vec3_sub(info->max, info->min);
    t->radius = 0.5 * vec3_length(extent);
    t->middle = vec3_sub(info->max, vec3_scale(extent, 0.5));
    t->material = calloc((size_t)info->materials, sizeof *t->material);
    relume_status status = t->material ? create_programs(t) : RELUME_ENOMEM;
    if (!status)
        status = shadow_map_create(&t->shadow, gl,
                                   gl->software ? SHADOW_SIDE_SOFTWARE : SHADOW_SIDE, log);
    if (!status) {
        upload_mesh(t, info);
        status = objects_drawer_upload_skins(t);
    }
    if (!status) {
        status = gl_check(gl, "uploading objects", log);
    }
    if (status)
        objects_drawer_destroy(t);
    return status;
}

// The last ones are what the surface is drawn into; the very last two only where it is tinted or
// sends something.
enum { SURFACES = 6, TARGETS = 11, FEWER = 2 };
static int find_targets(struct target *out[TARGETS], struct objects_drawer *t)
{
    struct target *const all[TARGETS] = {&t->shaded,    &t->other, &t->shown,  &t->sent,
                                         &t->arrived,   &t->place, &t->normal, &t->tangent,
                                         &t->footprint, &t->tint,  &t->emitted};
    memcpy(out, all, sizeof all);
    return t->tints || t->sends ? TARGETS : TARGETS - FEWER;
}

static void destroy_targets(struct objects_drawer *t)
{
    struct target *target[TARGETS];
    const int n = find_targets(target, t);
    for (int i = 0; i < n; i++)
        target_destroy(target[i], t->gl);
    t->gl->DeleteFramebuffers(1, &t->surface_buffer);
    t->gl->DeleteFramebuffers(1, &t->share_buffer);
    t->gl->DeleteTextures(1, &t->depth_texture);
    t->surface_buffer = t->share_buffer = t->depth_texture = 0;
}

void objects_drawer_destroy(struct objects_drawer *t)
{
    if (!t->gl)
        return;
    const int materials = t->material ? relume_objects_info(t->objects)->materials : 0;
    for (int i = 0; i < materials; i++)
        btf_release(&t->material[i], t->gl);
    for (int i = 0; i < t->programs; i++)
        program_destroy(&t->program[i].program, t->gl);
    struct program *const programs[] = {&t->surface, &t->depth, &t->over,
                                        &t->cast,    &t->share, &t->sky};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        program_destroy(programs[i], t->gl);
    destroy_targets(t);
    shadow_map_destroy(&t->shadow);
    light_uniforms_forget(&t->uniforms);
    sky_maps_forget(&t->maps);
    mirrors_forget(&t->mirrors);
    baked_forget(&t->baked);
    objects_drawer_forget_skins(t);
    t->gl->DeleteVertexArrays(1, &t->array);
    t->gl->DeleteBuffers(1, &t->vertices);
    t->gl->DeleteBuffers(1, &t->indices);
    t->gl->DeleteBuffers(1, &t->tints);
    relume_objects_destroy(&t->seen);
    free(t->program);
    free(t->material);
    relume_free(t->light_sample);
    free(t->light);
    *t = (struct objects_drawer){0};
}

size_t objects_drawer_bytes(const struct objects_drawer *t, int material)
{
    return t->material[material].bytes + baked_bytes(&t->baked, material);
}

// ---------------------------------------------------------------- what is needed

// A framebuffer that draws into `n` targets at once.
static relume_status join_targets(GLuint *out, struct objects_drawer *t,
                                  struct target *const *target, int n)
{
    const struct gl *gl = t->gl;
    GLenum buffers[SURFACES];
    gl->GenFramebuffers(1, out);
    gl->BindFramebuffer(GL_FRAMEBUFFER, *out);
    for (int i = 0; i < n; i++) {
        buffers[i] = GL_COLOR_ATTACHMENT0 + (GLenum)i;
        gl->FramebufferTexture2D(GL_FRAMEBUFFER, buffers[i], GL_TEXTURE_2D, target[i]->texture, 0);
    }
    gl->DrawBuffers(n, buffers);
    if (target[0] == &t->place)
        gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D,
                                 t->depth_texture, 0);
    if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE)
        return gl_check(gl, "objects", t->log);
    return say(t->log, RELUME_ESYSTEM, "OpenGL: cannot draw the surface of objects");
}

static relume_status need_targets(struct objects_drawer *t, int width, int height)
{
    const struct gl *gl = t->gl;
    struct target *target[TARGETS];
    relume_status status = RELUME_OK;
    width *= t->grid, height *= t->grid;
    if (t->place.width == width && t->place.height == height)
        return RELUME_OK;
    destroy_targets(t);
    const int n = find_targets(target, t), first = TARGETS - SURFACES;
    for (int i = 0; !status && i < n; i++)
        status = target_create(target[i], gl, width, height, t->log);
    if (status)
        return status;
    gl->GenTextures(1, &t->depth_texture);
    texture_use(gl, 0, GL_TEXTURE_2D, t->depth_texture);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, width, height, 0, GL_DEPTH_COMPONENT,
                   GL_FLOAT, NULL);
    texture_settings(gl, GL_TEXTURE_2D);
    status = join_targets(&t->surface_buffer, t, target + first, n - first);
    if (!status)
        status = join_targets(&t->share_buffer, t, target + first - 2, 2);
    if (status)
        destroy_targets(t);
    return status;
}

// The program of a model, compiled when it is first shown.
static relume_status need_program(const struct program **out, struct objects_drawer *t,
                                  const struct btf_shader *shader, bool sky)
{
    for (int i = 0; i < t->programs; i++)
        if (t->program[i].shader == shader && t->program[i].sky == sky) {
            *out = &t->program[i].program;
            return RELUME_OK;
        }
    struct objects_drawer_program *more =
        realloc(t->program, ((size_t)t->programs + 1) * sizeof *t->program);
    if (!more)
        return RELUME_ENOMEM;
    t->program = more;
    more[t->programs] = (struct objects_drawer_program){.shader = shader, .sky = sky};
    *out = &more[t->programs].program;
    return program_create_variant(&more[t->programs++].program, t->gl, shader->source,
                                  sky ? "#define SKY\n" : NULL, btf_uniforms, BTF_COUNT, t->log);
}

static relume_status need_material(struct objects_drawer *t, int i)
{
    if (t->material[i].shader)
        return RELUME_OK;
    return btf_upload(&t->material[i], t->gl, &relume_objects_info(t->objects)->material[i],
                      t->log);
}

relume_status objects_drawer_light(struct objects_drawer *t, const struct relume_light *lights,
                                   int n)
{
    struct relume_light *light = realloc(t->light, ((size_t)n + 1) * sizeof *light);
    if (!light)
        return RELUME_ENOMEM;
    memcpy(light, lights, (size_t)n * sizeof *light);
    t->light = light;
    t->lights = n;
    baked_unlight(&t->baked);
    relume_free(t->light_sample);
    return relume_objects_lights(&t->light_sample, &t->light_samples, t->objects, lights, n);
}

// ---------------------------------------------------------------- passes

static void draw_triangles(const struct objects_drawer *t, size_t first, size_t count)
{
    t->gl->DrawElements(GL_TRIANGLES, (GLsizei)(3 * count), GL_UNSIGNED_INT,
                        (const void *)(3 * first * sizeof(uint32_t)));
}

static void draw_all(void *context, const float clip[16])
{
    const struct objects_drawer *t = context;
    const struct relume_objects_info *info = objects_drawer_drawn(t);
    t->gl->UniformMatrix4fv(t->depth.at[SURFACE_CLIP], 1, GL_FALSE, clip);
    if (!t->holes)
        draw_triangles(t, 0, info->triangle_count);
    for (int i = 0; i < info->parts && t->holes; i++) {
        objects_drawer_use_skin(t, &t->depth, i);
        draw_triangles(t, info->part[i].first, info->part[i].count);
    }
    if (!t->captured)
        return;
    captured_mesh_draw(t->captured, clip);
    t->gl->UseProgram(t->depth.id);
    t->gl->BindVertexArray(t->array);
}

void objects_drawer_draw_shadow(struct objects_drawer *t, int light_sample)
{
    GLint before = 0;
    t->shadow.layers = 0;
    if (t->no_shadows)
        return;
    t->gl->GetIntegerv(GL_VERTEX_ARRAY_BINDING, &before);
    t->gl->BindVertexArray(t->array);
    t->gl->UseProgram(t->depth.id);
    shadow_map_fill(&t->shadow, &t->light_sample[light_sample], t->middle, t->radius, draw_all, t);
    t->gl->BindVertexArray((GLuint)before);
}

// `only` as objects_drawer_shade.
static void draw_surface(struct objects_drawer *t, const struct frame_projection *projection,
                         int only)
{
    const struct gl *gl = t->gl;
    const struct relume_objects_info *info = objects_drawer_drawn(t);
    GLint before = 0;
    gl->GetIntegerv(GL_VERTEX_ARRAY_BINDING, &before);
    gl->BindVertexArray(t->array);
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->surface_buffer);
    gl->Viewport(0, 0, t->place.width, t->place.height);
    gl->ClearColor(0, 0, 0, 0);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl->Enable(GL_DEPTH_TEST);
    gl->UseProgram(t->surface.id);
    gl->UniformMatrix4fv(t->surface.at[SURFACE_CLIP], 1, GL_FALSE, projection->clip);
    for (int i = 0; i < info->parts; i++) {
        const struct relume_object_part *part = &info->part[i];
        const bool mirror = info->material[only >= 0 ? only : part->material].mirror;
        objects_drawer_use_skin(t, &t->surface, i);
        gl->Uniform1i(t->surface.at[SURFACE_FIRST], mirror ? (GLint)part->first : -1);
        draw_triangles(t, part->first, part->count);
    }
    gl->Disable(GL_DEPTH_TEST);
    gl->BindVertexArray((GLuint)before);
}

static void set_uniforms(const struct objects_drawer *t, const struct program *program, int part,
                         const struct btf_material *m)
{
    const struct gl *gl = t->gl;
    const GLint *at = program->at;
    for (int i = 0; i < BTF_ARRAYS; i++)
        gl->Uniform1i(at[ARRAYS + i], i);
    for (int i = 0; i < BTF_MESHES; i++)
        gl->Uniform1i(at[MESHES + i], BTF_UNIT_MESHES + i);
    gl->Uniform1i(at[PLACE], BTF_UNIT_PLACE);
    gl->Uniform1i(at[NORMAL], BTF_UNIT_NORMAL);
    gl->Uniform1i(at[TANGENT], BTF_UNIT_TANGENT);
    gl->Uniform1i(at[FOOTPRINT], BTF_UNIT_FOOTPRINT);
    gl->Uniform1i(at[MAP_TEXELS], BTF_UNIT_MAP);
    texture_use(gl, BTF_UNIT_PLACE, GL_TEXTURE_2D, t->place.texture);
    texture_use(gl, BTF_UNIT_NORMAL, GL_TEXTURE_2D, t->normal.texture);
    texture_use(gl, BTF_UNIT_TANGENT, GL_TEXTURE_2D, t->tangent.texture);
    texture_use(gl, BTF_UNIT_FOOTPRINT, GL_TEXTURE_2D, t->footprint.texture);
    gl->Uniform1i(at[PART], part);
    gl->Uniform4f(at[EYE], t->projection.eye[0], t->projection.eye[1], t->projection.eye[2],
                  t->projection.eye[3]);
    gl->Uniform2i(at[FINEST], m->level->width, m->level->height);
    gl->Uniform1i(at[LEVELS], m->levels);
    gl->Uniform1i(at[BILINEAR], relume_objects_info(t->objects)->part[part].bilinear);
    gl->Uniform1i(at[WITHOUT_COSINE], m->without_cosine);
}

// Lights that one pass sums over: llvmpipe ends all loops of a pixel, without a word, after 65535
// rounds. A model goes through its components, at most once for each of three views, or follows two
// rays, for four texels at each of up to eight places.
static int lights_at_once(const struct btf_level *l)
{
    enum { MOST_ROUNDS = 60000, PLACES = 4 * 8, MESH_ROUNDS = 16 };
    const int rounds = PLACES * (MESH_ROUNDS + 3 * l->counts[2] + l->ray_steps);
    return rounds < MOST_ROUNDS ? MOST_ROUNDS / rounds : 1;
}

static void draw_level(const struct objects_drawer *t, const struct program *program,
                       const struct frame_area *area, const struct btf_level *l, bool sums)
{
    const int lights = l->counts[1], step = sums ? lights_at_once(l) : lights;
    for (int from = 0; from < lights; from += step) {
        const int end = from + step < lights ? from + step : lights;
        t->gl->Uniform2i(program->at[SOME_LIGHTS], from, end);
        objects_drawer_draw_whole(t->gl, program, area);
    }
}

// Each level of detail adds its part; `sums`: over the measured lights.
static void draw_levels(const struct objects_drawer *t, const struct program *program,
                        const struct target *target, const struct btf_material *m, bool sums)
{
    const struct gl *gl = t->gl;
    const GLint *at = program->at;
    const struct frame_area area = {.width = target->width, .height = target->height};
    for (int i = 0; i < m->levels; i++) {
        const struct btf_level *l = &m->level[i];
        gl->Uniform1i(at[LEVEL], i);
        gl->Uniform2i(at[TEXELS], l->width, l->height);
        gl->Uniform1i(at[AREA], l->area);
        gl->Uniform4i(at[MAP], l->map[0], l->map[1], l->map[2], l->map[3]);
        gl->Uniform4i(at[COUNTS], l->counts[0], l->counts[1], l->counts[2], l->counts[3]);
        gl->Uniform3f(at[RELIEF], l->relief[0], l->relief[1], l->relief[2]);
        gl->Uniform2i(at[SIDE], l->side[0], l->side[1]);
        btf_use(m, gl, i);
        draw_level(t, program, &area, l, sums);
    }
}

struct relume_light objects_drawer_light_of(const struct relume_object_light *light_sample)
{
    struct relume_light light = light_sample->light;
    if (!light_sample->is_patch)
        return light;
    light =
        (struct relume_light){.kind = RELUME_LIGHT_AREA, .position = light_sample->patch.position};
    memcpy(light.rgb, light_sample->patch.rgb, sizeof light.rgb);
    return light;
}

static relume_status use_material(const struct program **out, struct objects_drawer *t, int part,
                                  int material, bool sky)
{
    relume_status status = need_material(t, material);
    if (!status)
        status = need_program(out, t, t->material[material].shader, sky);
    if (status)
        return status;
    t->gl->UseProgram((*out)->id);
    set_uniforms(t, *out, part, &t->material[material]);
    return RELUME_OK;
}

// Mirrors and what is baked are no sums over light samples.
static bool has_own_pass(const struct objects_drawer *t, int material)
{
    const struct relume_object_material *m = &relume_objects_info(t->objects)->material[material];
    return m->mirror || m->baked;
}

static relume_status shade_part(struct objects_drawer *t, int part, int material, int light_sample)
{
    const struct program *program;
    const struct gl *gl = t->gl;
    if (has_own_pass(t, material))
        return RELUME_OK;
    relume_status status = use_material(&program, t, part, material, false);
    if (status)
        return status;
    const struct relume_light light = objects_drawer_light_of(&t->light_sample[light_sample]);
    gl->Uniform1i(program->at[PICTURE], BTF_UNIT_PICTURE);
    status = light_uniforms_set(&t->uniforms, program->at + LIGHT, BTF_UNIT_PICTURE, &light);
    if (t->light_sample[light_sample].is_patch) {
        const struct relume_vec3 n = t->light_sample[light_sample].patch.normal;
        gl->Uniform3f(program->at[LIGHT + LIGHT_AXIS], (float)n.x, (float)n.y, (float)n.z);
    }
    shadow_map_use(t->shadow.layers ? &t->shadow : NULL, gl, program->at + SHADOW, BTF_UNIT_SHADOW);
    if (!status)
        draw_levels(t, program, &t->shaded, &t->material[material], false);
    return status;
}

relume_status objects_drawer_shade_sky(struct objects_drawer *t, int part, int material,
                                       const struct relume_light *light)
{
    const struct sky_map *map;
    const struct program *program;
    const struct gl *gl = t->gl;
    if (has_own_pass(t, material))
        return RELUME_OK;
    relume_status status = need_material(t, material);
    struct btf_material *m = &t->material[material];
    if (!status)
        status = sky_maps_find(&map, &t->maps, light, m->rim);
    if (!status)
        status = btf_need_table(m, gl, &relume_objects_info(t->objects)->material[material],
                                map->prefiltered, t->log);
    if (!status)
        status = use_material(&program, t, part, material, true);
    if (status)
        return status;
    const GLint *at = program->at;
    gl->Uniform1i(at[SKY], BTF_UNIT_SKY);
    texture_use(gl, BTF_UNIT_SKY, GL_TEXTURE_2D, map->texture);
    gl->Uniform1i(at[SKY_TABLE], BTF_UNIT_TABLE);
    texture_use(gl, BTF_UNIT_TABLE, GL_TEXTURE_BUFFER, m->table);
    gl->Uniform1f(at[SKY_TURN], (float)(-light->rotate_deg * (M_PI / 180.0)));
    gl->Uniform3f(at[SKY_RGB], light->rgb[0], light->rgb[1], light->rgb[2]);
    draw_levels(t, program, &t->shown, m, !m->shader->lobes);
    return RELUME_OK;
}

static relume_status add_sample(struct objects_drawer *t, int light_sample, int only)
{
    const struct gl *gl = t->gl;
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    relume_status status = RELUME_OK;
    objects_drawer_draw_shadow(t, light_sample);
    target_resume(&t->shaded, gl);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    for (int i = 0; i < info->parts && !status; i++)
        status = shade_part(t, i, only >= 0 ? only : info->part[i].material, light_sample);
    gl->Disable(GL_BLEND);
    return status;
}

static relume_status add_baked(struct objects_drawer *t, int only)
{
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    const struct baked_surface surface = {&t->place, &t->normal, &t->tangent, t->projection.eye};
    relume_status status = RELUME_OK;
    for (int i = 0; i < info->parts && !status; i++) {
        const int material = only >= 0 ? only : info->part[i].material;
        if (!info->material[material].baked)
            continue;
        target_resume(&t->shaded, t->gl);
        status = baked_draw(&t->baked, t->objects, i, material, &surface, t->light, t->lights);
    }
    return status;
}

static relume_status add_mirrors(struct objects_drawer *t, int only)
{
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    const struct mirror_surface surface = {&t->place,   &t->normal, &t->footprint,
                                           t->vertices, t->indices, t->projection.eye};
    relume_status status = RELUME_OK;
    for (int i = 0; i < info->parts && !status; i++) {
        const int material = only >= 0 ? only : info->part[i].material;
        if (!info->material[material].mirror)
            continue;
        target_resume(&t->shaded, t->gl);
        status = mirrors_draw(&t->mirrors, t->objects, i, material, &surface, &t->panorama,
                              t->light, t->lights);
    }
    return status;
}

relume_status objects_drawer_shade(struct objects_drawer *t,
                                   const struct frame_projection *projection, int width, int height,
                                   int only)
{
    const struct gl *gl = t->gl;
    relume_status status = need_targets(t, width, height);
    if (!status)
        status = objects_drawer_see(t, projection);
    if (status)
        return status;
    t->projection = *projection;
    t->only = only;
    draw_surface(t, projection, only);
    target_begin(&t->shaded, gl);
    for (int i = 0; i < t->light_samples && !status; i++)
        if (!t->light_sample[i].is_sky)
            status = add_sample(t, i, only);
    for (int i = 0; i < t->lights && !status; i++)
        if (t->light[i].kind == RELUME_LIGHT_ENVIRONMENT)
            status = objects_drawer_add_sky(t, i, only);
    if (!status)
        status = add_baked(t, only);
    if (!status)
        status = add_mirrors(t, only);
    return status ? status : gl_check(gl, "drawing objects", t->log);
}

void objects_drawer_draw_whole(const struct gl *gl, const struct program *program,
                               const struct frame_area *area)
{
    draw_rectangle(gl, program, area, (struct app_rectangle){0, 0, area->width, area->height});
}

void objects_drawer_swap(struct objects_drawer *t)
{
    const struct target shaded = t->shaded;
    t->shaded = t->other;
    t->other = shaded;
}

void objects_drawer_over(const struct objects_drawer *t, const struct frame_area *area,
                         GLuint scene, bool difference)
{
    const struct gl *gl = t->gl;
    const GLint *at = t->over.at;
    gl->UseProgram(t->over.id);
    texture_use(gl, 0, GL_TEXTURE_2D, t->place.texture);
    texture_use(gl, 1, GL_TEXTURE_2D, t->shaded.texture);
    texture_use(gl, 2, GL_TEXTURE_2D, scene);
    texture_use(gl, 3, GL_TEXTURE_2D, t->other.texture);
    gl->Uniform1i(at[OVER_OTHER], 3);
    texture_use(gl, 5, GL_TEXTURE_2D, t->tint.texture);
    gl->Uniform1i(at[TINT], 5);
    gl->Uniform1i(at[TINTED], t->tints != 0);
    gl->Uniform1i(at[DIFFERENCE], difference);
    texture_use(gl, 6, GL_TEXTURE_2D, t->emitted.texture);
    gl->Uniform1i(at[EMITTED], 6);
    gl->Uniform1i(at[OVER_SENDS], t->sends);
    gl->Uniform1i(at[OVER_PLACE], 0);
    gl->Uniform1i(at[OVER_SHADED], 1);
    gl->Uniform1i(at[OVER_SCENE], 2);
    gl->Uniform1i(at[IN_SCENE], scene != 0);
    texture_use(gl, 4, GL_TEXTURE_2D, t->returned);
    gl->Uniform1i(at[OVER_RETURNED], 4);
    gl->Uniform1i(at[HAS_RETURNED], t->returned != 0);
    gl->Uniform1i(at[GRID], t->grid);
    gl->Uniform4f(at[OVER_EYE], t->projection.eye[0], t->projection.eye[1], t->projection.eye[2],
                  t->projection.eye[3]);
    gl->Uniform1f(at[EXPOSURE], area->exposure);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    objects_drawer_draw_whole(gl, &t->over, area);
    gl->Disable(GL_BLEND);
}

// A light sample of several: its direction times its value and 0, or its place and its value.
static void put_sample(float to[4], const struct relume_object_light *light_sample)
{
    const float *rgb = light_sample->is_patch ? light_sample->patch.rgb : light_sample->light.rgb;
    const struct relume_vec3 at =
        light_sample->is_patch ? light_sample->patch.position : light_sample->light.direction;
    const float value = rgb[0] + rgb[1] + rgb[2], scale = light_sample->is_patch ? 1.0f : value;
    to[0] = scale * (float)at.x;
    to[1] = scale * (float)at.y;
    to[2] = scale * (float)at.z;
    to[3] = light_sample->is_patch ? value : 0.0f;
}

// A single light sample counts whole.
static void use_samples(const struct objects_drawer *t, int light_sample)
{
    float at[RELUME_OBJECT_LIGHTS_MOST][4];
    const int n = t->light_samples > 1 ? t->light_samples : 0;
    for (int i = 0; i < n; i++)
        put_sample(at[i], &t->light_sample[i]);
    t->gl->Uniform1i(t->cast.at[CAST_OF], n);
    t->gl->Uniform1i(t->cast.at[CAST_SAMPLE], light_sample);
    if (n)
        t->gl->Uniform4fv(t->cast.at[CAST_SAMPLES], n, at[0]);
}

void objects_drawer_cast(struct objects_drawer *t, const struct frame_area *area, int light_sample,
                         GLuint scene, const struct target *lone)
{
    const struct gl *gl = t->gl;
    GLint before = 0, viewport[4];
    gl->GetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &before);
    gl->GetIntegerv(GL_VIEWPORT, viewport);
    objects_drawer_draw_shadow(t, light_sample);
    gl->BindFramebuffer(GL_FRAMEBUFFER, (GLuint)before);
    gl->Viewport(viewport[0], viewport[1], viewport[2], viewport[3]);
    gl->UseProgram(t->cast.id);
    texture_use(gl, 0, GL_TEXTURE_2D, scene);
    texture_use(gl, 1, GL_TEXTURE_2D, lone->texture);
    gl->Uniform1i(t->cast.at[CAST_SCENE], 0);
    gl->Uniform1i(t->cast.at[CAST_LONE], 1);
    use_samples(t, light_sample);
    shadow_map_use(t->shadow.layers ? &t->shadow : NULL, gl, t->cast.at + CAST_SHADOW, 2);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    objects_drawer_draw_whole(gl, &t->cast, area);
    gl->Disable(GL_BLEND);
}
