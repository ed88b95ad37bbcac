// objects_drawer.c - objects covered with measured materials, on the GPU
#include "draw/objects_drawer.h"

#include "draw/model_uniforms.h"
#include "draw/objects_drawer_parts.h"

#include <math.h>

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
// ---------------------------------------------------------------- making

static relume_status create_parts(struct objects_drawer *t)
{
    const struct gl *gl = t->gl;
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    relume_status status = object_materials_create(&t->materials, gl, t->objects, t->log);
    if (!status)
        status = object_surface_create(&t->surface, gl, t->log);
    if (!status)
        status = object_sky_create(&t->sky, gl, t->log);
    if (!status)
        status = program_create(&t->over, gl, "btf_over.frag", over_uniforms, OVER_COUNT, t->log);
    if (!status)
        status = object_shadows_create(&t->shadows, gl, info, t->log);
    if (status)
        return status;
    object_mesh_create(&t->mesh, gl, info);
    status = object_skins_create(&t->skins, gl, info, t->log);
    return status ? status : gl_check(gl, "uploading objects", t->log);
}

relume_status objects_drawer_create(struct objects_drawer *t, const struct gl *gl,
                                    relume_objects *objects, const struct relume_log *log)
{
    *t = (struct objects_drawer){.gl = gl,
                                 .log = log,
                                 .objects = objects,
                                 .uniforms = {.gl = gl, .log = log},
                                 .mirrors = {.gl = gl, .log = log},
                                 .baked = {.gl = gl, .log = log},
                                 .only = -1};
    const relume_status status = create_parts(t);
    if (status)
        objects_drawer_destroy(t);
    return status;
}

void objects_drawer_destroy(struct objects_drawer *t)
{
    if (!t->gl)
        return;
    object_materials_destroy(&t->materials);
    object_surface_destroy(&t->surface, t->gl);
    object_sky_destroy(&t->sky, t->gl);
    program_destroy(&t->over, t->gl);
    object_shadows_destroy(&t->shadows, t->gl);
    object_mesh_destroy(&t->mesh);
    object_skins_destroy(&t->skins, t->gl, relume_objects_info(t->objects));
    object_lights_destroy(&t->lights);
    target_destroy(&t->shaded, t->gl);
    target_destroy(&t->other, t->gl);
    light_uniforms_forget(&t->uniforms);
    mirrors_forget(&t->mirrors);
    baked_forget(&t->baked);
    *t = (struct objects_drawer){0};
}

size_t objects_drawer_bytes(const struct objects_drawer *t, int material)
{
    return t->materials.material[material].bytes + baked_bytes(&t->baked, material);
}

relume_status objects_drawer_light(struct objects_drawer *t, const struct relume_light *lights,
                                   int n)
{
    baked_unlight(&t->baked);
    return object_lights_set(&t->lights, t->objects, lights, n);
}

relume_status objects_drawer_see(struct objects_drawer *t,
                                 const struct frame_projection *projection)
{
    return object_mesh_see(&t->mesh, t->objects, projection, t->log);
}

static relume_status need_targets(struct objects_drawer *t, int width, int height)
{
    const struct target *like = &t->surface.position;
    const bool coloured = t->mesh.tints || t->skins.sends;
    relume_status status = object_surface_need(&t->surface, t->gl, width, height, coloured, t->log);
    if (!status)
        status = object_sky_need(&t->sky, t->gl, like->width, like->height, t->log);
    if (!status)
        status = target_need(&t->shaded, t->gl, like->width, like->height, t->log);
    return status ? status : target_need(&t->other, t->gl, like->width, like->height, t->log);
}

// ---------------------------------------------------------------- draws

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
    texture_use(gl, BTF_UNIT_PLACE, GL_TEXTURE_2D, t->surface.position.texture);
    texture_use(gl, BTF_UNIT_NORMAL, GL_TEXTURE_2D, t->surface.normal.texture);
    texture_use(gl, BTF_UNIT_TANGENT, GL_TEXTURE_2D, t->surface.tangent.texture);
    texture_use(gl, BTF_UNIT_FOOTPRINT, GL_TEXTURE_2D, t->surface.footprint.texture);
    gl->Uniform1i(at[PART], part);
    gl->Uniform4f(at[EYE], t->projection.eye[0], t->projection.eye[1], t->projection.eye[2],
                  t->projection.eye[3]);
    gl->Uniform2i(at[FINEST], m->level->width, m->level->height);
    gl->Uniform1i(at[LEVELS], m->levels);
    gl->Uniform1i(at[BILINEAR], relume_objects_info(t->objects)->part[part].bilinear);
    gl->Uniform1i(at[WITHOUT_COSINE], m->without_cosine);
}

static relume_status use_material(const struct program **out, struct objects_drawer *t, int part,
                                  int material, bool sky)
{
    relume_status status = object_materials_need(&t->materials, material);
    if (!status)
        status = object_materials_program(out, &t->materials, material, sky);
    if (status)
        return status;
    t->gl->UseProgram((*out)->id);
    set_uniforms(t, *out, part, &t->materials.material[material]);
    return RELUME_OK;
}

// Mirrors and what is baked are no sums over light samples.
static bool has_own_draw(const struct objects_drawer *t, int material)
{
    const struct relume_object_material *m = &relume_objects_info(t->objects)->material[material];
    return m->mirror || m->baked;
}

static relume_status shade_part(struct objects_drawer *t, int part, int material, int light_sample)
{
    const struct program *program;
    const struct gl *gl = t->gl;
    if (has_own_draw(t, material))
        return RELUME_OK;
    relume_status status = use_material(&program, t, part, material, false);
    if (status)
        return status;
    const struct relume_light light = object_lights_of(&t->lights.sample[light_sample]);
    gl->Uniform1i(program->at[PICTURE], BTF_UNIT_PICTURE);
    status = light_uniforms_set(&t->uniforms, program->at + LIGHT, BTF_UNIT_PICTURE, &light);
    if (t->lights.sample[light_sample].is_patch) {
        const struct relume_vec3 n = t->lights.sample[light_sample].patch.normal;
        gl->Uniform3f(program->at[LIGHT + LIGHT_AXIS], (float)n.x, (float)n.y, (float)n.z);
    }
    object_shadows_use(&t->shadows, gl, program->at + SHADOW, BTF_UNIT_SHADOW);
    if (!status)
        object_materials_draw(&t->materials, program, &t->shaded, material, false);
    return status;
}

relume_status objects_drawer_shade_sky(struct objects_drawer *t, int part, int material,
                                       const struct relume_light *light)
{
    const struct sky_map *map;
    const struct program *program;
    const struct gl *gl = t->gl;
    if (has_own_draw(t, material))
        return RELUME_OK;
    relume_status status = object_materials_need(&t->materials, material);
    struct btf_material *m = &t->materials.material[material];
    if (!status)
        status = sky_maps_find(&map, &t->sky.maps, light, m->rim);
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
    object_materials_draw(&t->materials, program, &t->sky.shown, material, !m->shader->lobes);
    return RELUME_OK;
}

static relume_status add_sample(struct objects_drawer *t, int light_sample)
{
    const struct gl *gl = t->gl;
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    const struct object_parts parts = objects_drawer_parts(t);
    relume_status status = RELUME_OK;
    object_shadows_draw(&t->shadows, &parts, &t->lights.sample[light_sample]);
    target_resume(&t->shaded, gl);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    for (int i = 0; i < info->parts && !status; i++)
        status = shade_part(t, i, object_parts_material(&parts, i), light_sample);
    gl->Disable(GL_BLEND);
    return status;
}

static relume_status add_baked(struct objects_drawer *t)
{
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    const struct object_parts parts = objects_drawer_parts(t);
    const struct baked_surface surface = {&t->surface.position, &t->surface.normal,
                                          &t->surface.tangent, t->projection.eye};
    relume_status status = RELUME_OK;
    for (int i = 0; i < info->parts && !status; i++) {
        const int material = object_parts_material(&parts, i);
        if (!info->material[material].baked)
            continue;
        target_resume(&t->shaded, t->gl);
        status = baked_draw(&t->baked, t->objects, i, material, &surface, t->lights.light,
                            t->lights.lights);
    }
    return status;
}

static relume_status add_mirrors(struct objects_drawer *t)
{
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    const struct object_parts parts = objects_drawer_parts(t);
    const struct mirror_surface surface = {&t->surface.position,  &t->surface.normal,
                                           &t->surface.footprint, t->mesh.vertices,
                                           t->mesh.indices,       t->projection.eye};
    relume_status status = RELUME_OK;
    for (int i = 0; i < info->parts && !status; i++) {
        const int material = object_parts_material(&parts, i);
        if (!info->material[material].mirror)
            continue;
        target_resume(&t->shaded, t->gl);
        status = mirrors_draw(&t->mirrors, t->objects, i, material, &surface, &t->panorama,
                              t->lights.light, t->lights.lights);
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
    const struct object_parts parts = objects_drawer_parts(t);
    object_surface_draw(&t->surface, &parts, projection);
    target_begin(&t->shaded, gl);
    for (int i = 0; i < t->lights.samples && !status; i++)
        if (!t->lights.sample[i].is_sky)
            status = add_sample(t, i);
    for (int i = 0; i < t->lights.lights && !status; i++)
        if (t->lights.light[i].kind == RELUME_LIGHT_ENVIRONMENT)
            status = objects_drawer_add_sky(t, i);
    if (!status)
        status = add_baked(t);
    if (!status)
        status = add_mirrors(t);
    return status ? status : gl_check(gl, "drawing objects", t->log);
}

void objects_drawer_swap(struct objects_drawer *t)
{
    target_swap(&t->shaded, &t->other);
}

void objects_drawer_over(const struct objects_drawer *t, const struct frame_area *area,
                         GLuint scene, bool difference)
{
    const struct gl *gl = t->gl;
    const GLint *at = t->over.at;
    gl->UseProgram(t->over.id);
    texture_use(gl, 0, GL_TEXTURE_2D, t->surface.position.texture);
    texture_use(gl, 1, GL_TEXTURE_2D, t->shaded.texture);
    texture_use(gl, 2, GL_TEXTURE_2D, scene);
    texture_use(gl, 3, GL_TEXTURE_2D, t->other.texture);
    gl->Uniform1i(at[OVER_OTHER], 3);
    texture_use(gl, 5, GL_TEXTURE_2D, t->surface.tint.texture);
    gl->Uniform1i(at[TINT], 5);
    gl->Uniform1i(at[TINTED], t->mesh.tints != 0);
    gl->Uniform1i(at[DIFFERENCE], difference);
    texture_use(gl, 6, GL_TEXTURE_2D, t->surface.emitted.texture);
    gl->Uniform1i(at[EMITTED], 6);
    gl->Uniform1i(at[OVER_SENDS], t->skins.sends);
    gl->Uniform1i(at[OVER_PLACE], 0);
    gl->Uniform1i(at[OVER_SHADED], 1);
    gl->Uniform1i(at[OVER_SCENE], 2);
    gl->Uniform1i(at[IN_SCENE], scene != 0);
    texture_use(gl, 4, GL_TEXTURE_2D, t->returned);
    gl->Uniform1i(at[OVER_RETURNED], 4);
    gl->Uniform1i(at[HAS_RETURNED], t->returned != 0);
    gl->Uniform1i(at[GRID], t->surface.grid);
    gl->Uniform4f(at[OVER_EYE], t->projection.eye[0], t->projection.eye[1], t->projection.eye[2],
                  t->projection.eye[3]);
    gl->Uniform1f(at[EXPOSURE], area->exposure);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    draw_whole(gl, &t->over, area);
    gl->Disable(GL_BLEND);
}

void objects_drawer_cast(struct objects_drawer *t, const struct frame_area *area, int light_sample,
                         GLuint scene, const struct target *lone)
{
    const struct object_parts parts = objects_drawer_parts(t);
    object_shadows_cast(&t->shadows, &parts, &t->lights, light_sample, area, scene, lone);
}
