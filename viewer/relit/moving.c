// moving.c - shadows and highlights that move, on the GPU
#include "relit/moving.h"

#include "cli/program/say.h"
#include "relight/shadow/moving.h"
#include "relit/moving_parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum trace_uniform {
    TRACE_RECTANGLE,
    TRACE_SIZE,
    TRACE_STAGE,
    TRACE_DIRECTION = TRACE_STAGE + STAGE_UNIFORMS,
    TRACE_ORIGIN,
    TRACE_COUNT
};
static const char *const trace_uniforms[] = {
    "rectangle", "frame_size", STAGE_NAMES, "direction", "origin",
};

// Of shadow.frag and gloss.frag, from OWN on of one of them.
enum moving_uniform {
    TOWARDS = SHOWN_UNIFORMS,
    AROUND,
    OWN,
    GLOSS_LIGHTS = OWN,
    GLOSS_COUNT,
    SHADOW_CAPTURED = OWN,
    SHADOW_ARRIVES,
    SHADOW_REACHED,
    SHADOW_COUNT = SHADOW_REACHED + 4
};
static const char *const gloss_uniforms[] = {SHOWN_NAMES, "towards", "around", "lights"};
static const char *const shadow_uniforms[] = {
    SHOWN_NAMES, "towards",  "around",   "captured", "arrives",
    "reached0",  "reached1", "reached2", "reached3",
};

enum { UNIT_ARRIVES = MOVING_UNITS, UNIT_LIGHTS = UNIT_ARRIVES, UNIT_REACHED };

static const float BACKGROUND = 1e30f;  // as stage.glsl

void moving_create(struct moving *m, const struct gl *gl, const struct relume_log *log)
{
    *m = (struct moving){.gl = gl, .log = log, .near = {.uniforms = {.gl = gl, .log = log}}};
}

void moving_forget(struct moving *m)
{
    light_uniforms_forget(&m->near.uniforms);
}

void moving_destroy(struct moving *m)
{
    if (!m->gl)
        return;
    program_destroy(&m->trace, m->gl);
    program_destroy(&m->shadow, m->gl);
    program_destroy(&m->gloss, m->gl);
    moving_near_destroy(&m->near, m->gl);
    m->gl->DeleteFramebuffers(1, &m->framebuffer);
    m->gl->DeleteTextures(1, &m->arrives);
    m->gl->DeleteTextures(1, &m->lights);
    *m = (struct moving){0};
}

// ---------------------------------------------------------------- views

static void upload(const struct gl *gl, GLuint *texture, GLint internal, GLenum format, int width,
                   int height, const float *texels)
{
    if (!*texture)
        gl->GenTextures(1, texture);
    texture_use(gl, 0, GL_TEXTURE_2D, *texture);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl->TexImage2D(GL_TEXTURE_2D, 0, internal, width, height, 0, format, GL_FLOAT, texels);
    texture_settings(gl, GL_TEXTURE_2D);
}

static float finite_of(float far)
{
    return far < BACKGROUND ? far : BACKGROUND;
}

static void upload_stage(struct moving_view *v, const struct gl *gl, float *scratch)
{
    const struct relume_shadows_stage *s = &v->stage;
    const size_t n = (size_t)s->width * (size_t)s->height;
    const size_t corners = ((size_t)s->width + 1) * ((size_t)s->height + 1);
    const int columns = (s->width + RELUME_SHADOW_TILE - 1) / RELUME_SHADOW_TILE;
    const int rows = (s->height + RELUME_SHADOW_TILE - 1) / RELUME_SHADOW_TILE;
    for (size_t i = 0; i < n; i++) {
        scratch[2 * i] = finite_of(s->far[i]);
        scratch[2 * i + 1] = s->thick[i];
    }
    upload(gl, &v->surface, GL_RG32F, GL_RG, s->width, s->height, scratch);
    for (size_t i = 0; i < 2 * corners; i++)
        scratch[i] = finite_of(s->span[i]);
    upload(gl, &v->span, GL_RG32F, GL_RG, s->width + 1, s->height + 1, scratch);
    for (size_t i = 0; i < (size_t)columns * (size_t)rows; i++)
        scratch[i] = finite_of(s->front[i]);
    upload(gl, &v->front, GL_R32F, GL_RED, columns, rows, scratch);
}

// Eight numbers a pixel as two texels; of background no colour.
static void upload_model(struct moving_view *v, const struct gl *gl, float *scratch)
{
    const struct relume_shadows_stage *s = &v->stage;
    const size_t n = (size_t)s->width * (size_t)s->height;
    for (size_t half = 0; half < 2; half++) {
        for (size_t i = 0; i < n; i++)
            for (size_t c = 0; c < 4; c++)
                scratch[4 * i + c] = s->gloss              ? s->gloss[8 * i + 4 * half + c]
                                     : half                ? s->matte[7 * i + 3 + c]
                                     : c == 3              ? 0.0f
                                     : isfinite(s->far[i]) ? s->matte[7 * i + c]
                                                           : 0.0f;
        upload(gl, half ? &v->matte : &v->colours, GL_RGBA32F, GL_RGBA, s->width, s->height,
               scratch);
    }
}

void moving_defines(char text[MOVING_DEFINES], const struct moving_view *v)
{
    snprintf(text, MOVING_DEFINES, "#define RAYS %d\n", (int)v->stage.rays);
}

static relume_status need_programs(struct moving *m, const struct moving_view *v)
{
    char rays[MOVING_DEFINES];
    if (v->stage.gloss)
        return m->gloss.id ? RELUME_OK
                           : program_create(&m->gloss, m->gl, "moving_gloss.frag", gloss_uniforms,
                                            GLOSS_COUNT, m->log);
    if (m->shadow.id)
        return RELUME_OK;
    moving_defines(rays, v);
    if (!m->framebuffer)
        m->gl->GenFramebuffers(1, &m->framebuffer);
    relume_status status = m->trace.id
                               ? RELUME_OK
                               : program_create_variant(&m->trace, m->gl, "moving_trace.frag", rays,
                                                        trace_uniforms, TRACE_COUNT, m->log);
    if (!status)
        status = program_create(&m->shadow, m->gl, "moving_shadow.frag", shadow_uniforms,
                                SHADOW_COUNT, m->log);
    return status;
}

relume_status moving_view_create(struct moving_view *v, struct moving *m, relume_shadows *shadows,
                                 const relume_coder *coder)
{
    *v = (struct moving_view){.shadows = shadows, .lights = relume_coder_info(coder)->lights};
    relume_shadows_look(&v->stage, shadows);
    const struct relume_shadows_stage *s = &v->stage;
    const size_t pixels = ((size_t)s->width + 1) * ((size_t)s->height + 1);
    const int most = m->gl->max_texture - 2;
    relume_status status = RELUME_OK;
    if (s->width > most || s->height > most)
        status =
            say(m->log, RELUME_ESYSTEM, "shadows of %d x %d: OpenGL draws at most %d x %d here",
                s->width, s->height, most, most);
    if (!status)
        status = need_programs(m, v);
    float *scratch = status ? NULL : malloc(4 * pixels * sizeof *scratch);
    v->reached = calloc((size_t)v->lights, sizeof *v->reached);
    if (!status && !(scratch && v->reached))
        status = RELUME_ENOMEM;
    if (!status) {
        if (!s->gloss)
            upload_stage(v, m->gl, scratch);
        upload_model(v, m->gl, scratch);
        v->bytes = (s->gloss ? 8 : 13) * pixels * sizeof(float);
        status = gl_check(m->gl, "uploading what moves", m->log);
    }
    free(scratch);
    if (status)
        moving_view_destroy(v, m->gl);
    return status;
}

void moving_view_destroy(struct moving_view *v, const struct gl *gl)
{
    const GLuint texture[] = {v->surface, v->span, v->front, v->colours, v->matte};
    gl->DeleteTextures(sizeof texture / sizeof *texture, texture);
    if (v->reached)
        gl->DeleteTextures(v->lights, v->reached);
    free(v->reached);
    *v = (struct moving_view){0};
}

// ---------------------------------------------------------------- where light arrives

void moving_set_stage(const struct gl *gl, const GLint *at, int unit, const struct moving_view *v)
{
    const struct relume_shadows_stage *s = &v->stage;
    const GLuint texture[STAGE_UNITS] = {v->surface, v->span, v->front};
    for (int i = 0; i < STAGE_UNITS; i++) {
        texture_use(gl, unit + i, GL_TEXTURE_2D, texture[i]);
        gl->Uniform1i(at[STAGE_SURFACE + i], unit + i);
    }
    gl->Uniform4f(at[STAGE_WINDOW], (float)s->scale[0], (float)s->scale[1], (float)s->shift[0],
                  (float)s->shift[1]);
    gl->Uniform1f(at[STAGE_AXIS], (float)s->axis);
    gl->Uniform1f(at[STAGE_PIXEL], (float)s->pixel);
    gl->Uniform1f(at[STAGE_LEAST], (float)s->least_side);
    gl_set_vec3(gl, at[STAGE_LOW], s->low);
    gl_set_vec3(gl, at[STAGE_HIGH], s->high);
}

// Into a texture of its own size: `rect` and a border of one pixel.
static relume_status trace(GLuint *texture, const struct moving *m, const struct moving_view *v,
                           struct relume_vec3 direction, const struct relume_rect *rect)
{
    const struct gl *gl = m->gl;
    const int width = rect->width + 2, height = rect->height + 2;
    upload(gl, texture, GL_R8, GL_RED, width, height, NULL);
    gl->BindFramebuffer(GL_FRAMEBUFFER, m->framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, *texture, 0);
    if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return say(m->log, RELUME_ESYSTEM, "OpenGL: cannot draw shadows of %d x %d", width, height);
    gl->Viewport(0, 0, width, height);
    gl->Disable(GL_BLEND);
    gl->UseProgram(m->trace.id);
    moving_set_stage(gl, m->trace.at + TRACE_STAGE, 0, v);
    gl_set_vec3(gl, m->trace.at[TRACE_DIRECTION], relume_pose_turn_back(&v->stage.pose, direction));
    gl->Uniform2i(m->trace.at[TRACE_ORIGIN], rect->left, rect->top);
    gl->Uniform4f(m->trace.at[TRACE_RECTANGLE], 0, 0, (float)width, (float)height);
    gl->Uniform2f(m->trace.at[TRACE_SIZE], (float)width, (float)height);
    gl->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    gl->Enable(GL_BLEND);
    return RELUME_OK;
}

static relume_status need_reached(struct moving_view *v, const struct moving *m, int light,
                                  struct relume_vec3 direction)
{
    const struct relume_rect all = {0, 0, v->stage.width, v->stage.height};
    if (v->reached[light])
        return RELUME_OK;
    const relume_status status = trace(&v->reached[light], m, v, direction, &all);
    if (!status)
        v->bytes += ((size_t)all.width + 2) * ((size_t)all.height + 2);
    return status;
}

// ---------------------------------------------------------------- what is shown

// The captured lights around the present one.
struct around {
    int *light;     // [lights]
    float *weight;  // [lights]
    int count;
};

void moving_set_shown(const struct gl *gl, const struct program *p, const struct moving_view *v,
                      const struct moving_picture *picture, const struct target *into)
{
    const struct target *whole = picture->whole ? picture->whole : picture->coded;
    const GLuint texture[MOVING_UNITS] = {[MOVING_UNIT_CODED] = picture->coded->texture,
                                          [MOVING_UNIT_WHOLE] = whole->texture,
                                          [MOVING_UNIT_COLOURS] = v->colours,
                                          [MOVING_UNIT_MATTE] = v->matte};
    const GLint *at = p->at;
    target_resume(into, gl);
    gl->UseProgram(p->id);
    for (int i = 0; i < MOVING_UNITS; i++)
        texture_use(gl, i, GL_TEXTURE_2D, texture[i]);
    gl->Uniform1i(at[SHOWN_CODED], MOVING_UNIT_CODED);
    gl->Uniform1i(at[SHOWN_WHOLE], MOVING_UNIT_WHOLE);
    gl->Uniform1i(at[SHOWN_COLOURS], MOVING_UNIT_COLOURS);
    gl->Uniform1i(at[SHOWN_MATTE], MOVING_UNIT_MATTE);
    gl->Uniform1i(at[SHOWN_CODING_CURVE], (GLint)picture->picture.curve);
    gl->Uniform1f(at[SHOWN_CODING_GAMMA], picture->picture.gamma);
    gl->Uniform1i(at[SHOWN_DISPLAY_CURVE], (GLint)picture->display.curve);
    gl->Uniform1f(at[SHOWN_DISPLAY_GAMMA], picture->display.gamma);
    gl->Uniform3f(at[SHOWN_TIMES], picture->times[0], picture->times[1], picture->times[2]);
    gl->Uniform3f(at[SHOWN_RGB], picture->rgb[0], picture->rgb[1], picture->rgb[2]);
    gl->Uniform2i(at[SHOWN_ORIGIN], picture->left, picture->top);
    gl->Uniform1i(at[SHOWN_EXCHANGES], picture->whole != NULL);
}

void moving_draw_all(const struct gl *gl, const struct program *p, const struct target *into)
{
    gl->Uniform4f(p->at[SHOWN_RECTANGLE], 0, 0, (float)into->width, (float)into->height);
    gl->Uniform2f(p->at[SHOWN_SIZE], (float)into->width, (float)into->height);
    gl->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

// By the program of a directional light.
static void set_light(const struct moving *m, const struct program *p, const struct moving_view *v,
                      const struct moving_picture *picture, int around, const struct target *into)
{
    moving_set_shown(m->gl, p, v, picture, into);
    gl_set_vec3(m->gl, p->at[TOWARDS], picture->direction);
    m->gl->Uniform1i(p->at[AROUND], around);
}

static void put_light(float texel[4], const struct relume_coder_info *info, const struct around *a,
                      int i)
{
    const struct relume_vec3 d = info->directions[a->light[i]];
    texel[0] = (float)d.x;
    texel[1] = (float)d.y;
    texel[2] = (float)d.z;
    texel[3] = a->weight[i];
}

static relume_status draw_gloss(struct moving *m, const struct moving_view *v,
                                const struct moving_picture *picture, const struct around *a,
                                const struct target *into)
{
    const struct gl *gl = m->gl;
    const struct relume_coder_info *info = relume_coder_info(picture->coder);
    float *texels = calloc((size_t)v->lights * 4, sizeof *texels);
    if (!texels)
        return RELUME_ENOMEM;
    for (int i = 0; i < a->count; i++)
        put_light(texels + 4 * i, info, a, i);
    upload(gl, &m->lights, GL_RGBA32F, GL_RGBA, v->lights, 1, texels);
    free(texels);
    set_light(m, &m->gloss, v, picture, a->count, into);
    texture_use(gl, UNIT_LIGHTS, GL_TEXTURE_2D, m->lights);
    gl->Uniform1i(m->gloss.at[GLOSS_LIGHTS], UNIT_LIGHTS);
    moving_draw_all(gl, &m->gloss, into);
    return RELUME_OK;
}

static relume_status draw_shadow(struct moving *m, struct moving_view *v,
                                 const struct moving_picture *picture, const struct around *a,
                                 const struct target *into)
{
    const struct gl *gl = m->gl;
    const struct relume_coder_info *info = relume_coder_info(picture->coder);
    const struct relume_rect rect = {picture->left, picture->top, into->width, into->height};
    float captured[4][4] = {{0}};
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < a->count; i++) {
        put_light(captured[i], info, a, i);
        status = need_reached(v, m, a->light[i], info->directions[a->light[i]]);
    }
    if (!status)
        status = trace(&m->arrives, m, v, picture->direction, &rect);
    if (status)
        return status;
    set_light(m, &m->shadow, v, picture, a->count, into);
    texture_use(gl, UNIT_ARRIVES, GL_TEXTURE_2D, m->arrives);
    gl->Uniform1i(m->shadow.at[SHADOW_ARRIVES], UNIT_ARRIVES);
    for (int i = 0; i < 4; i++) {
        texture_use(gl, UNIT_REACHED + i, GL_TEXTURE_2D,
                    i < a->count ? v->reached[a->light[i]] : m->arrives);
        gl->Uniform1i(m->shadow.at[SHADOW_REACHED + i], UNIT_REACHED + i);
    }
    gl->Uniform4fv(m->shadow.at[SHADOW_CAPTURED], 4, captured[0]);
    moving_draw_all(gl, &m->shadow, into);
    return RELUME_OK;
}

relume_status moving_draw(struct moving *m, struct moving_view *v,
                          const struct moving_picture *picture, const struct target *into)
{
    struct around a = {.light = malloc((size_t)v->lights * sizeof *a.light),
                       .weight = malloc((size_t)v->lights * sizeof *a.weight)};
    relume_status status = a.light && a.weight ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = relume_shadows_around(a.light, a.weight, &a.count, v->shadows, picture->coder,
                                       picture->direction, picture->whole != NULL);
    if (!status)
        status = v->stage.gloss ? draw_gloss(m, v, picture, &a, into)
                                : draw_shadow(m, v, picture, &a, into);
    free(a.light);
    free(a.weight);
    return status;
}
