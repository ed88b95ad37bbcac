#include "things.h"

#include "say.h"
#include "vec.h"

#include <stddef.h>

#include <stdlib.h>
#include <string.h>

enum {
    ARRAYS = DRAW_OWN,
    DOMES = ARRAYS + BTF_ARRAYS,
    PLACE = DOMES + BTF_DOMES,
    NORMAL,
    TANGENT,
    PICTURE,
    PART,
    EYE,
    TEXELS,
    BILINEAR,
    WITHOUT_COSINE,
    COUNTS,
    AREA,
    MAP,
    MAP_TEXELS,
    LIGHT,
    SHADOW = LIGHT + SHINE_UNIFORMS,
    BTF_COUNT = SHADOW + SHADOW_UNIFORMS
};
static const char *const btf_uniforms[] = {
    "rectangle",      "frame_size",  "array0",
    "array1",         "array2",      "array3",
    "array4",         "array5",      "view_cells",
    "view_triangles", "light_cells", "light_triangles",
    "place",          "normal_s",    "tangent_t",
    "picture",        "part",        "eye",
    "texels",         "bilinear",    "without_cosine",
    "counts",         "area",        "map",
    "map_texels",     SHINE_NAMES,   SHADOW_NAMES,
};
enum { SURFACE_CLIP, SURFACE_PART, SURFACE_COUNT };
static const char *const surface_uniforms[] = {"clip", "part"};
enum {
    OVER_PLACE = DRAW_OWN,
    OVER_SHADED,
    OVER_OTHER,
    DIFFERENCE,
    OVER_SCENE,
    IN_SCENE,
    GRID,
    OVER_EYE,
    EXPOSURE,
    OVER_COUNT
};
static const char *const over_uniforms[] = {"rectangle", "frame_size", "place",   "shaded",
                                            "other",     "difference", "scene",   "in_scene",
                                            "grid",      "eye",        "exposure"};
enum {
    CAST_SCENE = DRAW_OWN,
    CAST_LONE,
    WEIGHT,
    CAST_SHADOW,
    CAST_COUNT = CAST_SHADOW + SHADOW_UNIFORMS
};
static const char *const cast_uniforms[] = {"rectangle", "frame_size", "scene",
                                            "lone",      "weight",     SHADOW_NAMES};

// Where OpenGL is software, a smaller map and no finer grid.
enum { SHADOW_SIDE = 2048, SHADOW_SIDE_SOFTWARE = 1024, FINER = 2 };

// ---------------------------------------------------------------- making

static void upload_mesh(struct things *t, const struct relume_objects_info *info)
{
    const struct gl *gl = t->gl;
    static const struct {
        GLint numbers;
        size_t offset;
    } attribute[] = {{3, offsetof(struct relume_object_vertex, position)},
                     {3, offsetof(struct relume_object_vertex, normal)},
                     {4, offsetof(struct relume_object_vertex, tangent)},
                     {2, offsetof(struct relume_object_vertex, texture)}};
    gl->GenVertexArrays(1, &t->array);
    gl->BindVertexArray(t->array);
    gl->GenBuffers(1, &t->vertices);
    gl->BindBuffer(GL_ARRAY_BUFFER, t->vertices);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(info->vertex_count * sizeof *info->vertices),
                   info->vertices, GL_STATIC_DRAW);
    gl->GenBuffers(1, &t->indices);
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, t->indices);
    gl->BufferData(GL_ELEMENT_ARRAY_BUFFER,
                   (GLsizeiptr)(info->triangle_count * sizeof *info->triangles), info->triangles,
                   GL_STATIC_DRAW);
    for (GLuint i = 0; i < 4; i++) {
        gl->EnableVertexAttribArray(i);
        gl->VertexAttribPointer(i, attribute[i].numbers, GL_FLOAT, GL_FALSE,
                                sizeof(struct relume_object_vertex),
                                (const char *)NULL + attribute[i].offset);
    }
}

static relume_status create_programs(struct things *t)
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
    return status;
}

relume_status things_create(struct things *t, const struct gl *gl, relume_objects *objects,
                            const struct relume_log *log)
{
    const struct relume_objects_info *info = relume_objects_info(objects);
    *t = (struct things){.gl = gl,
                         .log = log,
                         .objects = objects,
                         .shine = {.gl = gl, .log = log},
                         .grid = gl->software ? 1 : FINER};
    const struct relume_vec3 extent = vec_sub(info->max, info->min);
    t->radius = 0.5 * vec_length(extent);
    t->middle = vec_sub(info->max, vec_scale(extent, 0.5));
    t->material = calloc((size_t)info->materials, sizeof *t->material);
    relume_status status = t->material ? create_programs(t) : RELUME_ENOMEM;
    if (!status)
        status = shadow_map_create(&t->shadow, gl,
                                   gl->software ? SHADOW_SIDE_SOFTWARE : SHADOW_SIDE, log);
    if (!status) {
        upload_mesh(t, info);
        status = gl_check(gl, "uploading objects", log);
    }
    if (status)
        things_destroy(t);
    return status;
}

static void destroy_targets(struct things *t)
{
    struct target *const targets[] = {&t->place, &t->normal, &t->tangent, &t->shaded, &t->other};
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++)
        target_destroy(targets[i], t->gl);
    t->gl->DeleteFramebuffers(1, &t->surface_buffer);
    t->gl->DeleteTextures(1, &t->depth_texture);
    t->surface_buffer = t->depth_texture = 0;
}

void things_destroy(struct things *t)
{
    if (!t->gl)
        return;
    const int materials = t->material ? relume_objects_info(t->objects)->materials : 0;
    for (int i = 0; i < materials; i++)
        btf_release(&t->material[i], t->gl);
    for (int i = 0; i < t->programs; i++)
        program_destroy(&t->program[i].program, t->gl);
    struct program *const programs[] = {&t->surface, &t->depth, &t->over, &t->cast};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        program_destroy(programs[i], t->gl);
    destroy_targets(t);
    shadow_map_destroy(&t->shadow);
    shine_forget(&t->shine);
    t->gl->DeleteVertexArrays(1, &t->array);
    t->gl->DeleteBuffers(1, &t->vertices);
    t->gl->DeleteBuffers(1, &t->indices);
    free(t->program);
    free(t->material);
    free(t->lamp);
    *t = (struct things){0};
}

void things_forget(struct things *t)
{
    shine_forget(&t->shine);
}

size_t things_bytes(const struct things *t, int material)
{
    return t->material[material].bytes;
}

// ---------------------------------------------------------------- what is needed

static relume_status need_targets(struct things *t, int width, int height)
{
    const struct gl *gl = t->gl;
    struct target *const targets[] = {&t->place, &t->normal, &t->tangent, &t->shaded, &t->other};
    relume_status status = RELUME_OK;
    width *= t->grid, height *= t->grid;
    if (t->place.width == width && t->place.height == height)
        return RELUME_OK;
    destroy_targets(t);
    for (size_t i = 0; !status && i < sizeof targets / sizeof *targets; i++)
        status = target_create(targets[i], gl, width, height, t->log);
    if (status)
        return status;
    gl->GenTextures(1, &t->depth_texture);
    texture_use(gl, 0, GL_TEXTURE_2D, t->depth_texture);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, width, height, 0, GL_DEPTH_COMPONENT,
                   GL_FLOAT, NULL);
    texture_settings(gl, GL_TEXTURE_2D);
    gl->GenFramebuffers(1, &t->surface_buffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->surface_buffer);
    for (GLenum i = 0; i < 3; i++)
        gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + i, GL_TEXTURE_2D,
                                 targets[i]->texture, 0);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, t->depth_texture,
                             0);
    const GLenum buffers[3] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
    gl->DrawBuffers(3, buffers);
    if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE)
        return gl_check(gl, "objects", t->log);
    destroy_targets(t);
    return say(t->log, RELUME_ESYSTEM, "OpenGL: cannot draw the surface of objects");
}

// The program of a model, compiled when it is first shown.
static relume_status need_program(const struct program **out, struct things *t,
                                  const struct btf_twin *twin)
{
    for (int i = 0; i < t->programs; i++)
        if (t->program[i].twin == twin) {
            *out = &t->program[i].program;
            return RELUME_OK;
        }
    struct things_program *more =
        realloc(t->program, ((size_t)t->programs + 1) * sizeof *t->program);
    if (!more)
        return RELUME_ENOMEM;
    t->program = more;
    more[t->programs] = (struct things_program){.twin = twin};
    *out = &more[t->programs].program;
    return program_create(&more[t->programs++].program, t->gl, twin->shader, btf_uniforms,
                          BTF_COUNT, t->log);
}

static relume_status need_material(struct things *t, int i)
{
    if (t->material[i].twin)
        return RELUME_OK;
    return btf_upload(&t->material[i], t->gl, &relume_objects_info(t->objects)->material[i],
                      t->log);
}

relume_status things_light(struct things *t, const struct relume_light *lights, int n)
{
    free(t->lamp);
    return relume_objects_lamps(&t->lamp, &t->lamps, t->objects, lights, n);
}

// ---------------------------------------------------------------- passes

static void draw_all(void *context, const float clip[16])
{
    const struct things *t = context;
    t->gl->UniformMatrix4fv(t->depth.at[SURFACE_CLIP], 1, GL_FALSE, clip);
    t->gl->DrawElements(GL_TRIANGLES,
                        (GLsizei)(3 * relume_objects_info(t->objects)->triangle_count),
                        GL_UNSIGNED_INT, NULL);
}

static void draw_shadow(struct things *t, int lamp)
{
    GLint before = 0;
    t->shadow.layers = 0;
    if (t->no_shadows)
        return;
    t->gl->GetIntegerv(GL_VERTEX_ARRAY_BINDING, &before);
    t->gl->BindVertexArray(t->array);
    t->gl->UseProgram(t->depth.id);
    shadow_map_fill(&t->shadow, &t->lamp[lamp], t->middle, t->radius, draw_all, t);
    t->gl->BindVertexArray((GLuint)before);
}

static void draw_surface(struct things *t, const struct sight *sight)
{
    const struct gl *gl = t->gl;
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    GLint before = 0;
    gl->GetIntegerv(GL_VERTEX_ARRAY_BINDING, &before);
    gl->BindVertexArray(t->array);
    gl->BindFramebuffer(GL_FRAMEBUFFER, t->surface_buffer);
    gl->Viewport(0, 0, t->place.width, t->place.height);
    gl->ClearColor(0, 0, 0, 0);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl->Enable(GL_DEPTH_TEST);
    gl->UseProgram(t->surface.id);
    gl->UniformMatrix4fv(t->surface.at[SURFACE_CLIP], 1, GL_FALSE, sight->clip);
    for (int i = 0; i < info->parts; i++) {
        const struct relume_object_part *part = &info->part[i];
        gl->Uniform1i(t->surface.at[SURFACE_PART], i);
        gl->DrawElements(GL_TRIANGLES, (GLsizei)(3 * part->count), GL_UNSIGNED_INT,
                         (const char *)NULL + 3 * part->first * sizeof(uint32_t));
    }
    gl->Disable(GL_DEPTH_TEST);
    gl->BindVertexArray((GLuint)before);
}

static void set_uniforms(const struct things *t, const struct program *program, int part,
                         const struct btf_material *m)
{
    const struct gl *gl = t->gl;
    const GLint *at = program->at;
    for (int i = 0; i < BTF_ARRAYS; i++)
        gl->Uniform1i(at[ARRAYS + i], i);
    for (int i = 0; i < BTF_DOMES; i++)
        gl->Uniform1i(at[DOMES + i], BTF_UNIT_DOMES + i);
    gl->Uniform1i(at[PLACE], BTF_UNIT_PLACE);
    gl->Uniform1i(at[NORMAL], BTF_UNIT_NORMAL);
    gl->Uniform1i(at[TANGENT], BTF_UNIT_TANGENT);
    gl->Uniform1i(at[PICTURE], BTF_UNIT_PICTURE);
    texture_use(gl, BTF_UNIT_PLACE, GL_TEXTURE_2D, t->place.texture);
    texture_use(gl, BTF_UNIT_NORMAL, GL_TEXTURE_2D, t->normal.texture);
    texture_use(gl, BTF_UNIT_TANGENT, GL_TEXTURE_2D, t->tangent.texture);
    gl->Uniform1i(at[PART], part);
    gl->Uniform4f(at[EYE], t->sight.eye[0], t->sight.eye[1], t->sight.eye[2], t->sight.eye[3]);
    gl->Uniform2i(at[TEXELS], m->width, m->height);
    gl->Uniform1i(at[BILINEAR], relume_objects_info(t->objects)->part[part].bilinear);
    gl->Uniform1i(at[WITHOUT_COSINE], m->without_cosine);
    gl->Uniform1i(at[AREA], m->area);
    gl->Uniform4i(at[MAP], m->map[0], m->map[1], m->map[2], m->map[3]);
    gl->Uniform1i(at[MAP_TEXELS], BTF_UNIT_MAP);
    gl->Uniform4i(at[COUNTS], m->counts[0], m->counts[1], m->counts[2], m->counts[3]);
}

// A lamp as a light: a facet is an area light's piece, its normal the axis.
static struct relume_light light_of(const struct relume_lamp *lamp)
{
    struct relume_light light = lamp->light;
    if (!lamp->is_facet)
        return light;
    light = (struct relume_light){.kind = RELUME_LIGHT_AREA, .position = lamp->facet.position};
    memcpy(light.rgb, lamp->facet.rgb, sizeof light.rgb);
    return light;
}

static relume_status shade_part(struct things *t, int part, int material, int lamp)
{
    const struct program *program;
    const struct gl *gl = t->gl;
    relume_status status = need_material(t, material);
    if (!status)
        status = need_program(&program, t, t->material[material].twin);
    if (status)
        return status;
    const struct relume_light light = light_of(&t->lamp[lamp]);
    gl->UseProgram(program->id);
    set_uniforms(t, program, part, &t->material[material]);
    status = shine_set(&t->shine, program->at + LIGHT, BTF_UNIT_PICTURE, &light);
    if (t->lamp[lamp].is_facet) {
        const struct relume_vec3 n = t->lamp[lamp].facet.normal;
        gl->Uniform3f(program->at[LIGHT + SHINE_AXIS], (float)n.x, (float)n.y, (float)n.z);
    }
    shadow_map_use(t->shadow.layers ? &t->shadow : NULL, gl, program->at + SHADOW, BTF_UNIT_SHADOW);
    btf_use(&t->material[material], gl);
    const struct place place = {.width = t->shaded.width, .height = t->shaded.height};
    if (!status)
        draw_rectangle(gl, program, &place,
                       (struct app_rectangle){0, 0, place.width, place.height});
    return status;
}

relume_status things_shade(struct things *t, const struct sight *sight, int width, int height,
                           int only)
{
    const struct gl *gl = t->gl;
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    relume_status status = need_targets(t, width, height);
    if (status)
        return status;
    t->sight = *sight;
    draw_surface(t, sight);
    target_begin(&t->shaded, gl);
    for (int lamp = 0; lamp < t->lamps && !status; lamp++) {
        draw_shadow(t, lamp);
        target_resume(&t->shaded, gl);
        gl->Enable(GL_BLEND);
        gl->BlendFunc(GL_ONE, GL_ONE);
        for (int i = 0; i < info->parts && !status; i++)
            status = shade_part(t, i, only >= 0 ? only : info->part[i].material, lamp);
        gl->Disable(GL_BLEND);
    }
    return status ? status : gl_check(gl, "drawing objects", t->log);
}

static void draw_whole(const struct gl *gl, const struct program *program,
                       const struct place *place)
{
    draw_rectangle(gl, program, place, (struct app_rectangle){0, 0, place->width, place->height});
}

void things_swap(struct things *t)
{
    const struct target shaded = t->shaded;
    t->shaded = t->other;
    t->other = shaded;
}

void things_over(const struct things *t, const struct place *place, GLuint scene, bool difference)
{
    const struct gl *gl = t->gl;
    const GLint *at = t->over.at;
    gl->UseProgram(t->over.id);
    texture_use(gl, 0, GL_TEXTURE_2D, t->place.texture);
    texture_use(gl, 1, GL_TEXTURE_2D, t->shaded.texture);
    texture_use(gl, 2, GL_TEXTURE_2D, scene);
    texture_use(gl, 3, GL_TEXTURE_2D, t->other.texture);
    gl->Uniform1i(at[OVER_OTHER], 3);
    gl->Uniform1i(at[DIFFERENCE], difference);
    gl->Uniform1i(at[OVER_PLACE], 0);
    gl->Uniform1i(at[OVER_SHADED], 1);
    gl->Uniform1i(at[OVER_SCENE], 2);
    gl->Uniform1i(at[IN_SCENE], scene != 0);
    gl->Uniform1i(at[GRID], t->grid);
    gl->Uniform4f(at[OVER_EYE], t->sight.eye[0], t->sight.eye[1], t->sight.eye[2], t->sight.eye[3]);
    gl->Uniform1f(at[EXPOSURE], place->exposure);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    draw_whole(gl, &t->over, place);
    gl->Disable(GL_BLEND);
}

static float value_of(const struct relume_lamp *lamp)
{
    const float *rgb = lamp->is_facet ? lamp->facet.rgb : lamp->light.rgb;
    return rgb[0] + rgb[1] + rgb[2];
}

static float share_of(const struct things *t, int lamp)
{
    float sum = 0.0f;
    for (int i = 0; i < t->lamps; i++)
        sum += value_of(&t->lamp[i]);
    return sum > 0.0f ? value_of(&t->lamp[lamp]) / sum : 0.0f;
}

void things_cast(struct things *t, const struct place *place, int lamp, GLuint scene,
                 const struct target *lone)
{
    const struct gl *gl = t->gl;
    GLint before = 0, viewport[4];
    gl->GetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &before);
    gl->GetIntegerv(GL_VIEWPORT, viewport);
    draw_shadow(t, lamp);
    gl->BindFramebuffer(GL_FRAMEBUFFER, (GLuint)before);
    gl->Viewport(viewport[0], viewport[1], viewport[2], viewport[3]);
    gl->UseProgram(t->cast.id);
    texture_use(gl, 0, GL_TEXTURE_2D, scene);
    texture_use(gl, 1, GL_TEXTURE_2D, lone->texture);
    gl->Uniform1i(t->cast.at[CAST_SCENE], 0);
    gl->Uniform1i(t->cast.at[CAST_LONE], 1);
    gl->Uniform1f(t->cast.at[WEIGHT], share_of(t, lamp));
    shadow_map_use(t->shadow.layers ? &t->shadow : NULL, gl, t->cast.at + CAST_SHADOW, 2);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    draw_whole(gl, &t->cast, place);
    gl->Disable(GL_BLEND);
}
