// shadow_map.c - what a light sample sees of the objects: depths, for shadow.glsl
#include "draw/shadow_map.h"

#include "cli/program/say.h"
#include "common/vec.h"
#include "gl/target.h"
#include "relight/light/environment.h"
#include "world/object/drawn_objects.h"

#include <string.h>

relume_status shadow_map_create(struct shadow_map *map, const struct gl *gl, int side,
                                const struct relume_log *log)
{
    *map = (struct shadow_map){.gl = gl, .side = side};
    gl->GenTextures(1, &map->texture);
    texture_use(gl, 0, GL_TEXTURE_2D_ARRAY, map->texture);
    gl->TexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT32F, side, side, SHADOW_LAYERS, 0,
                   GL_DEPTH_COMPONENT, GL_FLOAT, NULL);
    texture_settings(gl, GL_TEXTURE_2D_ARRAY);
    gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    gl->TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    gl->GenFramebuffers(1, &map->framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, map->framebuffer);
    gl->FramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, map->texture, 0, 0);
    const GLenum none = GL_NONE;
    gl->DrawBuffers(1, &none);
    gl->ReadBuffer(GL_NONE);
    if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE)
        return gl_check(gl, "shadows", log);
    shadow_map_destroy(map);
    return say(log, RELUME_ESYSTEM, "OpenGL: cannot draw shadows of %d x %d", side, side);
}

void shadow_map_destroy(struct shadow_map *map)
{
    if (!map->gl)
        return;
    map->gl->DeleteFramebuffers(1, &map->framebuffer);
    map->gl->DeleteTextures(1, &map->texture);
    *map = (struct shadow_map){0};
}

// ---------------------------------------------------------------- where it looks

struct view {
    struct relume_vec3 eye, right, up, ahead;
};

// A row of a matrix that is kept by columns: dot(axis, point - eye) * scale.
static void set_row(float clip[16], int row, struct relume_vec3 axis, struct relume_vec3 eye,
                    double scale, double offset)
{
    clip[row] = (float)(axis.x * scale);
    clip[4 + row] = (float)(axis.y * scale);
    clip[8 + row] = (float)(axis.z * scale);
    clip[12 + row] = (float)(offset - scale * vec3_dot(axis, eye));
}

static void set_near(float clip[16], const struct view *v, double tangent, double from, double to)
{
    set_row(clip, 0, v->right, v->eye, 1.0 / tangent, 0.0);
    set_row(clip, 1, v->up, v->eye, 1.0 / tangent, 0.0);
    set_row(clip, 2, v->ahead, v->eye, (to + from) / (to - from), -2.0 * to * from / (to - from));
    set_row(clip, 3, v->ahead, v->eye, 1.0, 0.0);
}

static struct view view_along(struct relume_vec3 eye, struct relume_vec3 ahead)
{
    struct view v = {.eye = eye, .ahead = ahead};
    relume_light_frame(&v.right, &v.up, ahead);
    return v;
}

static void aim_cube(struct shadow_map *map, struct relume_vec3 eye, double reach)
{
    // as cube.glsl
    static const struct relume_vec3 ahead[6] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                                {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    map->layers = 6;
    map->texel = 2.0f / (float)map->side;
    for (int i = 0; i < 6; i++) {
        const struct view v = view_along(eye, ahead[i]);
        // a hair wider, so that neighbours of a texel on the edge are there
        set_near(map->clip[i], &v, 1.0 + 2.0 / map->side, 1e-3 * reach, reach);
    }
}

static void aim(struct shadow_map *map, const struct relume_object_light *light_sample,
                struct relume_vec3 middle, double radius)
{
    const bool near = light_sample->is_patch || relume_light_is_near(light_sample->light.kind);
    const struct relume_vec3 at = !near                    ? light_sample->light.direction
                                  : light_sample->is_patch ? light_sample->patch.position
                                                           : light_sample->light.position;
    const float place[4] = {(float)at.x, (float)at.y, (float)at.z, near ? 1.0f : 0.0f};
    memcpy(map->light, place, sizeof map->light);
    map->layers = 1;
    if (!near) {
        const struct view v = view_along(middle, vec3_scale(at, -1.0));
        memset(map->clip[0], 0, 16 * sizeof *map->clip[0]);
        set_row(map->clip[0], 0, v.right, v.eye, 1.0 / radius, 0.0);
        set_row(map->clip[0], 1, v.up, v.eye, 1.0 / radius, 0.0);
        set_row(map->clip[0], 2, v.ahead, v.eye, 1.0 / radius, 0.0);
        map->clip[0][15] = 1.0f;
        map->texel = (float)(2.0 * radius / map->side);
        return;
    }
    const struct relume_vec3 way = vec3_sub(middle, at);
    const double apart = vec3_length(way);
    if (apart < 1.2 * radius) {
        aim_cube(map, at, apart + radius);
        return;
    }
    const struct view v = view_along(at, vec3_scale(way, 1.0 / apart));
    const double tangent = radius / sqrt(apart * apart - radius * radius);
    set_near(map->clip[0], &v, tangent, apart - radius, apart + radius);
    map->texel = (float)(2.0 * tangent / map->side);
}

void shadow_map_fill(struct shadow_map *map, const struct relume_object_light *light_sample,
                     struct relume_vec3 middle, double radius,
                     void (*draw)(void *context, const float clip[16]), void *context)
{
    const struct gl *gl = map->gl;
    aim(map, light_sample, middle, radius);
    gl->BindFramebuffer(GL_FRAMEBUFFER, map->framebuffer);
    gl->Viewport(0, 0, map->side, map->side);
    gl->Enable(GL_DEPTH_TEST);
    for (int i = 0; i < map->layers; i++) {
        gl->FramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, map->texture, 0, i);
        gl->Clear(GL_DEPTH_BUFFER_BIT);
        draw(context, map->clip[i]);
    }
    gl->Disable(GL_DEPTH_TEST);
}

void shadow_map_use(const struct shadow_map *map, const struct gl *gl, const GLint *at, int unit)
{
    gl->Uniform1i(at[SHADOW_MAP], unit);
    gl->Uniform1i(at[SHADOW_LAYER_COUNT], map ? map->layers : 0);
    if (!map)
        return;
    texture_use(gl, unit, GL_TEXTURE_2D_ARRAY, map->texture);
    gl->UniformMatrix4fv(at[SHADOW_CLIP], map->layers, GL_FALSE, map->clip[0]);
    gl->Uniform4f(at[SHADOW_LIGHT], map->light[0], map->light[1], map->light[2], map->light[3]);
    gl->Uniform1f(at[SHADOW_TEXEL], map->texel);
}
