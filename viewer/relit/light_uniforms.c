// light_uniforms.c - a light as uniforms of light.glsl, and the pictures that some lights need as
// textures
#include "relit/light_uniforms.h"

#include "cli/program/say.h"
#include "common/vec.h"
#include "gl/program.h"
#include "gl/target.h"
#include "relight/light/environment.h"

#include <stdlib.h>
#include <string.h>

struct light_uniforms_picture {
    const void *key;
    GLuint texture;
    struct light_uniforms_picture *next;
};

void light_uniforms_forget(struct light_uniforms *s)
{
    while (s->picture) {
        struct light_uniforms_picture *p = s->picture;
        s->picture = p->next;
        s->gl->DeleteTextures(1, &p->texture);
        free(p);
    }
}

void light_uniforms_upload(const struct gl *gl, int unit, GLuint texture, GLint internal,
                           GLenum format, int width, int height, const float *values)
{
    texture_use(gl, unit, GL_TEXTURE_2D, texture);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl->TexImage2D(GL_TEXTURE_2D, 0, internal, width, height, 0, format, GL_FLOAT, values);
    texture_settings(gl, GL_TEXTURE_2D);
}

// Every half degree; the file's own angles are rarely finer.
static relume_status upload_ies(const struct gl *gl, int unit, GLuint texture,
                                const relume_ies *ies)
{
    enum { ACROSS = 721, DOWN = 361 };
    float *texels = malloc((size_t)ACROSS * DOWN * sizeof *texels);
    if (!texels)
        return RELUME_ENOMEM;
    for (int y = 0; y < DOWN; y++)
        for (int x = 0; x < ACROSS; x++)
            texels[y * ACROSS + x] = (float)relume_ies_value(ies, 0.5 * y, 0.5 * x);
    light_uniforms_upload(gl, unit, texture, GL_R32F, GL_RED, ACROSS, DOWN, texels);
    free(texels);
    return RELUME_OK;
}

static relume_status upload_slide(const struct light_uniforms *s, int unit, GLuint texture,
                                  const struct relume_image *image)
{
    const int most = s->gl->max_texture;
    if (image->width > most || image->height > most)
        return say(s->log, RELUME_ESYSTEM,
                   "a light's picture of %d x %d: OpenGL takes at most %d x %d "
                   "here",
                   image->width, image->height, most, most);
    light_uniforms_upload(s->gl, unit, texture, GL_RGB32F, GL_RGB, image->width, image->height,
                          image->data);
    return RELUME_OK;
}

static const void *key_of(const struct relume_light *light)
{
    switch (light->kind) {
    case RELUME_LIGHT_SLIDE: return light->image;
    case RELUME_LIGHT_IES: return light->ies;
    case RELUME_LIGHT_GONIO: return light->gonio;
    default: return NULL;
    }
}

static relume_status upload_light(const struct light_uniforms *s, int unit, GLuint texture,
                                  const struct relume_light *light)
{
    if (light->kind == RELUME_LIGHT_IES)
        return upload_ies(s->gl, unit, texture, light->ies);
    return upload_slide(s, unit, texture,
                        light->kind == RELUME_LIGHT_SLIDE ? light->image
                                                          : relume_gonio_map(light->gonio));
}

static relume_status use_picture(struct light_uniforms *s, int unit,
                                 const struct relume_light *light)
{
    const void *key = key_of(light);
    struct light_uniforms_picture *p = s->picture;
    while (p && p->key != key)
        p = p->next;
    relume_status status = RELUME_OK;
    if (!p) {
        p = calloc(1, sizeof *p);
        if (!p)
            return RELUME_ENOMEM;
        s->gl->GenTextures(1, &p->texture);
        status = upload_light(s, unit, p->texture, light);
        p->next = s->picture;
        s->picture = p;
        p->key = status ? NULL : key;
    }
    texture_use(s->gl, unit, GL_TEXTURE_2D, p->texture);
    return status;
}

relume_status light_uniforms_set(struct light_uniforms *s, const GLint *at, int unit,
                                 const struct relume_light *l)
{
    const struct gl *gl = s->gl;
    const relume_status status = key_of(l) ? use_picture(s, unit, l) : RELUME_OK;
    gl->Uniform1i(at[LIGHT_KIND], (GLint)l->kind);
    gl->Uniform3f(at[LIGHT_RGB], l->rgb[0], l->rgb[1], l->rgb[2]);
    gl->Uniform1i(at[LIGHT_NOFALL], l->nofall);
    gl_set_vec3(gl, at[LIGHT_POSITION], l->position);
    gl->Uniform1f(at[LIGHT_HALF_ANGLE], (float)(l->half_angle_deg * (M_PI / 180.0)));
    if (l->kind != RELUME_LIGHT_POINT && l->kind != RELUME_LIGHT_AREA &&
        l->kind != RELUME_LIGHT_ENVIRONMENT) {
        struct relume_vec3 right, up;
        relume_light_frame(&right, &up, l->direction);
        gl_set_vec3(gl, at[LIGHT_AXIS], vec3_unit(l->direction));
        gl_set_vec3(gl, at[LIGHT_RIGHT], right);
        gl_set_vec3(gl, at[LIGHT_UP], up);
    }
    return status;
}

static void put_vec3(float *texel, struct relume_vec3 v)
{
    texel[0] = (float)v.x;
    texel[1] = (float)v.y;
    texel[2] = (float)v.z;
}

relume_status light_uniforms_patches(const struct gl *gl, int unit, GLuint texture,
                                     const struct relume_light *area, int side)
{
    struct relume_light_patch patch[RELUME_LIGHT_PATCHES_MOST * RELUME_LIGHT_PATCHES_MOST];
    const int n = side * side;
    float *texels = malloc((size_t)n * 9 * sizeof *texels);
    if (!texels)
        return RELUME_ENOMEM;
    relume_light_patches(patch, area, side);
    for (int i = 0; i < n; i++) {
        put_vec3(texels + 3 * i, patch[i].position);
        put_vec3(texels + 3 * (n + i), patch[i].normal);
        memcpy(texels + 3 * (2 * n + i), patch[i].rgb, sizeof patch[i].rgb);
    }
    light_uniforms_upload(gl, unit, texture, GL_RGB32F, GL_RGB, n, 3, texels);
    free(texels);
    return RELUME_OK;
}
