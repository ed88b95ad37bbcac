// object_shadows.c - shadows that objects throw, on themselves and on the scene
#include "draw/object_shadows.h"

#include "common/vec.h"
#include "world/object/drawn_objects.h"

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

// Texels of the map; where OpenGL is software fewer.
enum { SHADOW_SIDE = 2048, SHADOW_SIDE_SOFTWARE = 1024 };

relume_status object_shadows_create(struct object_shadows *s, const struct gl *gl,
                                    const struct relume_objects_info *info,
                                    const struct relume_log *log)
{
    const struct relume_vec3 extent = vec3_sub(info->max, info->min);
    *s = (struct object_shadows){.radius = 0.5 * vec3_length(extent),
                                 .middle = vec3_sub(info->max, vec3_scale(extent, 0.5))};
    relume_status status = object_parts_program(&s->depth, gl, "btf_depth.frag", log);
    if (!status)
        status = program_create(&s->cast, gl, "btf_cast.frag", cast_uniforms, CAST_COUNT, log);
    return status ? status
                  : shadow_map_create(&s->map, gl,
                                      gl->software ? SHADOW_SIDE_SOFTWARE : SHADOW_SIDE, log);
}

void object_shadows_destroy(struct object_shadows *s, const struct gl *gl)
{
    program_destroy(&s->depth, gl);
    program_destroy(&s->cast, gl);
    shadow_map_destroy(&s->map);
}

// ---------------------------------------------------------------- the map

struct shadow_caster {
    const struct object_shadows *shadows;
    const struct object_parts *parts;
};

static void draw_caster(void *context, const float clip[16])
{
    const struct shadow_caster *c = context;
    const struct program *depth = &c->shadows->depth;
    const struct object_mesh *mesh = c->parts->mesh;
    mesh->gl->UniformMatrix4fv(depth->at[SURFACE_CLIP], 1, GL_FALSE, clip);
    if (c->parts->skins->holes)
        object_parts_draw(c->parts, depth);
    else
        object_parts_draw_whole(c->parts);
    if (!c->shadows->captured)
        return;
    captured_mesh_draw(c->shadows->captured, clip);
    mesh->gl->UseProgram(depth->id);
    mesh->gl->BindVertexArray(mesh->array);
}

void object_shadows_draw(struct object_shadows *s, const struct object_parts *parts,
                         const struct relume_object_light *sample)
{
    const struct gl *gl = parts->mesh->gl;
    struct shadow_caster caster = {s, parts};
    GLint before = 0;
    s->map.layers = 0;
    if (s->off)
        return;
    gl->GetIntegerv(GL_VERTEX_ARRAY_BINDING, &before);
    gl->BindVertexArray(parts->mesh->array);
    gl->UseProgram(s->depth.id);
    shadow_map_fill(&s->map, sample, s->middle, s->radius, draw_caster, &caster);
    gl->BindVertexArray((GLuint)before);
}

void object_shadows_use(const struct object_shadows *s, const struct gl *gl, const GLint *at,
                        int unit)
{
    shadow_map_use(s->map.layers ? &s->map : NULL, gl, at, unit);
}

// ---------------------------------------------------------------- on the scene

// A light sample of several: its direction times its value and 0, or its place and its value.
static void put_sample(float to[4], const struct relume_object_light *sample)
{
    const float *rgb = sample->is_patch ? sample->patch.rgb : sample->light.rgb;
    const struct relume_vec3 at =
        sample->is_patch ? sample->patch.position : sample->light.direction;
    const float value = rgb[0] + rgb[1] + rgb[2], scale = sample->is_patch ? 1.0f : value;
    to[0] = scale * (float)at.x;
    to[1] = scale * (float)at.y;
    to[2] = scale * (float)at.z;
    to[3] = sample->is_patch ? value : 0.0f;
}

// A single light sample counts whole.
static void use_samples(const struct object_shadows *s, const struct gl *gl,
                        const struct object_lights *lights, int sample)
{
    float at[RELUME_OBJECT_LIGHTS_MOST][4];
    const int n = lights->samples > 1 ? lights->samples : 0;
    for (int i = 0; i < n; i++)
        put_sample(at[i], &lights->sample[i]);
    gl->Uniform1i(s->cast.at[CAST_OF], n);
    gl->Uniform1i(s->cast.at[CAST_SAMPLE], sample);
    if (n)
        gl->Uniform4fv(s->cast.at[CAST_SAMPLES], n, at[0]);
}

void object_shadows_cast(struct object_shadows *s, const struct object_parts *parts,
                         const struct object_lights *lights, int sample,
                         const struct frame_area *area, GLuint scene, const struct target *lone)
{
    const struct gl *gl = parts->mesh->gl;
    GLint before = 0, viewport[4];
    gl->GetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &before);
    gl->GetIntegerv(GL_VIEWPORT, viewport);
    object_shadows_draw(s, parts, &lights->sample[sample]);
    gl->BindFramebuffer(GL_FRAMEBUFFER, (GLuint)before);
    gl->Viewport(viewport[0], viewport[1], viewport[2], viewport[3]);
    gl->UseProgram(s->cast.id);
    texture_use(gl, 0, GL_TEXTURE_2D, scene);
    texture_use(gl, 1, GL_TEXTURE_2D, lone->texture);
    gl->Uniform1i(s->cast.at[CAST_SCENE], 0);
    gl->Uniform1i(s->cast.at[CAST_LONE], 1);
    use_samples(s, gl, lights, sample);
    object_shadows_use(s, gl, s->cast.at + CAST_SHADOW, 2);
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ONE, GL_ONE);
    draw_whole(gl, &s->cast, area);
    gl->Disable(GL_BLEND);
}
