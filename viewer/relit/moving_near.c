// moving_near.c - near lights whose shadows move, on the GPU
#include "relit/moving.h"

#include "relight/light/refit.h"
#include "relight/shadow/moving.h"
#include "relit/captured_uniforms.h"
#include "relit/moving_parts.h"

#include <math.h>
#include <stdlib.h>

enum near_uniform {
    STAGE = SHOWN_UNIFORMS,
    LIGHT = STAGE + STAGE_UNIFORMS,
    ZONE = LIGHT + LIGHT_UNIFORMS,
    PATCHES = ZONE + ZONE_UNIFORMS,
    PICTURE,
    TRIANGLES,
    TRIANGLE_COUNT,
    POSITIONS,
    LIGHTS,
    TURN_BACK,
    UNIFORMS
};
static const char *const uniforms[] = {
    SHOWN_NAMES, STAGE_NAMES,      LIGHT_NAMES, ZONE_NAMES, "patches",   "picture",
    "triangles", "triangle_count", "positions", "lights",   "turn_back",
};

// Texture units; each sampler has its own.
enum unit {
    UNIT_STAGE = MOVING_UNITS,
    UNIT_PICTURE = UNIT_STAGE + STAGE_UNITS,
    UNIT_BORDER,
    UNIT_TRIANGLES,
    UNIT_POSITIONS,
    UNIT_LIGHTS
};

enum { SIDE = 4 };  // of an area light's patches, as near.frag and src/relight/shadow/shadows.c

void moving_near_destroy(struct moving_near *near, const struct gl *gl)
{
    const GLuint texture[] = {near->triangles, near->border, near->lights, near->patches};
    gl->DeleteTextures(sizeof texture / sizeof *texture, texture);
    program_destroy(&near->program, gl);
    light_uniforms_forget(&near->uniforms);
    *near = (struct moving_near){0};
}

static relume_status upload_lights(const struct moving *m, const relume_coder *coder)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    float *texels = calloc((size_t)info->lights * 4, sizeof *texels);
    if (!texels)
        return RELUME_ENOMEM;
    for (int i = 0; i < info->lights; i++) {
        texels[4 * i] = (float)info->directions[i].x;
        texels[4 * i + 1] = (float)info->directions[i].y;
        texels[4 * i + 2] = (float)info->directions[i].z;
    }
    light_uniforms_upload(m->gl, UNIT_LIGHTS, m->near.lights, GL_RGBA32F, GL_RGBA, info->lights, 1,
                          texels);
    free(texels);
    return RELUME_OK;
}

static relume_status make(struct moving *m, const struct moving_view *v, const relume_coder *coder)
{
    const struct gl *gl = m->gl;
    struct moving_near *n = &m->near;
    char rays[MOVING_DEFINES];
    GLuint *const texture[] = {&n->triangles, &n->border, &n->lights, &n->patches};
    for (size_t i = 0; i < sizeof texture / sizeof *texture; i++)
        if (!*texture[i])
            gl->GenTextures(1, texture[i]);
    moving_defines(rays, v);
    zone_upload(gl, UNIT_BORDER, n->border, coder);
    relume_status status = upload_lights(m, coder);
    if (!status && !n->program.id)
        status = program_create_variant(&n->program, gl, "moving_near.frag", rays, uniforms,
                                        UNIFORMS, m->log);
    return status ? status : gl_check(gl, "uploading captured lights", m->log);
}

relume_status moving_near_can(bool *can, struct moving *m, const struct moving_view *v,
                              const relume_coder *coder)
{
    const relume_coder *between;
    relume_weight_grid *grid = NULL;
    *can = m->near.triangle_count > 0;
    if (m->near.ready)
        return RELUME_OK;
    relume_status status = relume_shadows_between(&between, v->shadows, coder);
    if (!status)
        status = relume_weight_grid_create(&grid, between, NULL);
    const struct relume_weight_grid_info *info = grid ? relume_weight_grid_info(grid) : NULL;
    *can = info && info->triangles && triangles_rows(info) <= m->gl->max_texture &&
           relume_coder_info(coder)->lights <= m->gl->max_texture;
    if (!status && *can)
        status = make(m, v, coder);
    if (!status && *can)
        status = triangles_upload(m->gl, UNIT_TRIANGLES, m->near.triangles, info);
    if (!status && *can)
        m->near.triangle_count = info->triangles;
    m->near.ready = !status;
    relume_weight_grid_destroy(&grid);
    return status;
}

// Columns are what becomes of the world's axes.
static void set_turn_back(const struct gl *gl, GLint at, const struct relume_pose *pose)
{
    float matrix[16] = {[15] = 1.0f};
    for (int i = 0; i < 3; i++) {
        const struct relume_vec3 axis = {i == 0, i == 1, i == 2};
        const struct relume_vec3 turned = relume_pose_turn_back(pose, axis);
        matrix[4 * i] = (float)turned.x;
        matrix[4 * i + 1] = (float)turned.y;
        matrix[4 * i + 2] = (float)turned.z;
    }
    gl->UniformMatrix4fv(at, 1, GL_FALSE, matrix);
}

static void use_texture(const struct gl *gl, GLint at, enum unit unit, GLuint texture)
{
    texture_use(gl, unit, GL_TEXTURE_2D, texture);
    gl->Uniform1i(at, unit);
}

relume_status moving_draw_near(struct moving *m, const struct moving_view *v,
                               const struct moving_picture *picture,
                               const struct relume_light *light, GLuint positions,
                               const struct target *into)
{
    const struct gl *gl = m->gl;
    struct moving_near *n = &m->near;
    const GLint *at = n->program.at;
    const bool area = light->kind == RELUME_LIGHT_AREA;
    moving_set_shown(gl, &n->program, v, picture, into);
    moving_set_stage(gl, at + STAGE, UNIT_STAGE, v);
    zone_set(gl, at + ZONE, UNIT_BORDER, n->border, picture->coder);
    use_texture(gl, at[TRIANGLES], UNIT_TRIANGLES, n->triangles);
    use_texture(gl, at[POSITIONS], UNIT_POSITIONS, positions);
    use_texture(gl, at[LIGHTS], UNIT_LIGHTS, n->lights);
    gl->Uniform1i(at[TRIANGLE_COUNT], n->triangle_count);
    gl->Uniform1i(at[PICTURE], UNIT_PICTURE);
    gl->Uniform1i(at[PATCHES], area ? SIDE * SIDE : 0);
    set_turn_back(gl, at[TURN_BACK], &v->stage.pose);
    relume_status status =
        area ? light_uniforms_patches(gl, UNIT_PICTURE, n->patches, light, SIDE) : RELUME_OK;
    if (!status)
        status = light_uniforms_set(&n->uniforms, at + LIGHT, UNIT_PICTURE, light);
    if (!status)
        moving_draw_all(gl, &n->program, into);
    return status;
}
