// gl_aperture.c - the aperture of an eye as a texture of transmittance, drawn with blending that
// multiplies
#include "glare/gl_aperture.h"

#include "cli/program/say.h"
#include "gl/target.h"
#include "relight/eye/pupil.h"

#include <math.h>
#include <stddef.h>

enum { SIZE = 0, COUNT };
static const char *const uniforms[] = {"texture_size"};
enum { RECTANGLE, FRAME, OPENING_SIZE, FIXED, RADIUS, LIDS, HAS_LIDS, OPENING_COUNT };
static const char *const opening_uniforms[] = {
    "rectangle", "frame_size", "texture_size", "fixed_parts", "radius", "lids", "has_lids"};

static void make_texture(GLuint *out, const struct gl *gl, int size)
{
    gl->GenTextures(1, out);
    texture_use(gl, 0, GL_TEXTURE_2D, *out);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_R32F, size, size, 0, GL_RED, GL_FLOAT, NULL);
    texture_settings(gl, GL_TEXTURE_2D);
}

static void draw_into(const struct gl_aperture *a, const struct gl *gl, GLuint texture)
{
    gl->BindFramebuffer(GL_FRAMEBUFFER, a->framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    gl->Viewport(0, 0, a->size, a->size);
}

relume_status gl_aperture_create(struct gl_aperture *a, const struct gl *gl, int size,
                                 double texel_mm, unsigned parts_off, const struct relume_log *log)
{
    *a = (struct gl_aperture){.size = size, .texel_mm = texel_mm, .parts_off = parts_off};
    gl->GenVertexArrays(1, &a->vertices);
    gl->GenBuffers(1, &a->buffer);
    gl->GenFramebuffers(1, &a->framebuffer);
    make_texture(&a->texture, gl, size);
    make_texture(&a->fixed, gl, size);
    draw_into(a, gl, a->texture);
    if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return say(log, RELUME_ESYSTEM, "OpenGL: cannot draw into a texture of %d x %d floats",
                   size, size);
    relume_status status = program_create_with(&a->disc, gl, "glare_disc.vert", "glare_disc.frag",
                                               uniforms, COUNT, log);
    if (!status)
        status = program_create_with(&a->stroke, gl, "glare_stroke.vert", "glare_stroke.frag",
                                     uniforms, COUNT, log);
    if (!status)
        status = program_create(&a->opening, gl, "glare_opening.frag", opening_uniforms,
                                OPENING_COUNT, log);
    return status ? status : gl_check(gl, "aperture", log);
}

void gl_aperture_destroy(struct gl_aperture *a, const struct gl *gl)
{
    program_destroy(&a->disc, gl);
    program_destroy(&a->stroke, gl);
    program_destroy(&a->opening, gl);
    gl->DeleteTextures(1, &a->texture);
    gl->DeleteTextures(1, &a->fixed);
    gl->DeleteFramebuffers(1, &a->framebuffer);
    gl->DeleteBuffers(1, &a->buffer);
    gl->DeleteVertexArrays(1, &a->vertices);
    *a = (struct gl_aperture){0};
}

// ---------------------------------------------------------------- primitives

static void attribute(const struct gl *gl, GLuint index, int floats, size_t stride, size_t offset)
{
    gl->EnableVertexAttribArray(index);
    gl->VertexAttribPointer(index, floats, GL_FLOAT, GL_FALSE, (GLsizei)stride,
                            (const void *)offset);
    gl->VertexAttribDivisor(index, 1);
}

static void draw_all(const struct gl_aperture *a, const struct gl *gl, const struct program *p,
                     int count)
{
    gl->UseProgram(p->id);
    gl->Uniform2f(p->at[SIZE], (float)a->size, (float)(1 / a->texel_mm));
    gl->Enable(GL_BLEND);
    gl->BlendFunc(GL_ZERO, GL_SRC_COLOR);
    gl->DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count);
    gl->Disable(GL_BLEND);
}

static bool wanted(const struct gl_aperture *a, struct relume_eye_range range, unsigned part)
{
    return range.count > 0 && !(a->parts_off & part);
}

static void draw_discs(const struct gl_aperture *a, const struct gl *gl,
                       const struct relume_aperture *m, struct relume_eye_range range,
                       unsigned part)
{
    if (!wanted(a, range, part))
        return;
    gl->BindBuffer(GL_ARRAY_BUFFER, a->buffer);
    gl->BufferData(GL_ARRAY_BUFFER, range.count * (GLsizeiptr)sizeof *m->disc,
                   m->disc + range.first, GL_STREAM_DRAW);
    attribute(gl, 0, 4, sizeof *m->disc, offsetof(struct relume_eye_disc, x));
    draw_all(a, gl, &a->disc, range.count);
}

static void draw_strokes(const struct gl_aperture *a, const struct gl *gl,
                         const struct relume_aperture *m, struct relume_eye_range range,
                         unsigned part)
{
    if (!wanted(a, range, part))
        return;
    gl->BindBuffer(GL_ARRAY_BUFFER, a->buffer);
    gl->BufferData(GL_ARRAY_BUFFER, range.count * (GLsizeiptr)sizeof *m->stroke,
                   m->stroke + range.first, GL_STREAM_DRAW);
    attribute(gl, 0, 4, sizeof *m->stroke, offsetof(struct relume_eye_stroke, x));
    attribute(gl, 1, 3, sizeof *m->stroke, offsetof(struct relume_eye_stroke, width));
    draw_all(a, gl, &a->stroke, range.count);
}

// ---------------------------------------------------------------- opening

static double half_width(const struct relume_aperture *m, double y, bool lids)
{
    const double radius = (double)m->pupil_radius, rest = radius * radius - y * y;
    if (rest <= 0 || (lids && (y >= (double)m->upper[0] || y <= (double)m->lower[0])))
        return 0;
    double width = sqrt(rest);
    if (lids && m->upper[1] < 0)
        width = fmin(width, sqrt((y - (double)m->upper[0]) / (double)m->upper[1]));
    if (lids && m->lower[1] > 0)
        width = fmin(width, sqrt((y - (double)m->lower[0]) / (double)m->lower[1]));
    return width;
}

double gl_aperture_light(const struct relume_aperture *m)
{
    enum { LINES = 4096 };
    const double radius = (double)m->pupil_radius;
    double open = 0, all = 0;
    for (int k = 0; k < LINES; k++) {
        const double y = radius * (2 * (k + 0.5) / LINES - 1);
        open += half_width(m, y, true);
        all += half_width(m, y, false);
    }
    return all > 0 ? open / all : 0;
}

static void draw_opening(const struct gl_aperture *a, const struct gl *gl,
                         const struct relume_aperture *m)
{
    const struct program *p = &a->opening;
    texture_use(gl, 0, GL_TEXTURE_2D, a->fixed);
    const float from = (float)a->from, to = (float)a->to;
    gl->ClearColor(0, 0, 0, 0);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    gl->UseProgram(p->id);
    gl->Uniform4f(p->at[RECTANGLE], from, from, to, to);
    gl->Uniform2f(p->at[FRAME], (float)a->size, (float)a->size);
    gl->Uniform2f(p->at[OPENING_SIZE], (float)a->size, (float)(1 / a->texel_mm));
    gl->Uniform1i(p->at[FIXED], 0);
    gl->Uniform1f(p->at[RADIUS], m->pupil_radius);
    gl->Uniform4f(p->at[LIDS], m->lower[0], m->lower[1], m->upper[0], m->upper[1]);
    gl->Uniform1i(p->at[HAS_LIDS], !(a->parts_off & RELUME_EYE_LIDS));
    gl->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

static void draw_fixed(struct gl_aperture *a, const struct gl *gl, const struct relume_aperture *m)
{
    draw_into(a, gl, a->fixed);
    gl->ClearColor(1, 1, 1, 1);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    draw_discs(a, gl, m, m->cornea, RELUME_EYE_CORNEA);
    draw_strokes(a, gl, m, m->fibres, RELUME_EYE_FIBRES);
    a->drawn = true;
}

void gl_aperture_draw(struct gl_aperture *a, const struct gl *gl, const struct relume_aperture *m)
{
    const double middle = 0.5 * a->size + 0.5, radius = (double)m->pupil_radius / a->texel_mm;
    a->from = relume_whole(fmax(floor(middle - radius), 0));
    a->to = relume_whole(fmin(ceil(middle + radius), a->size));
    gl->BindVertexArray(a->vertices);
    if (!a->drawn)
        draw_fixed(a, gl, m);
    draw_into(a, gl, a->texture);
    draw_opening(a, gl, m);
    draw_discs(a, gl, m, m->lens, RELUME_EYE_LENS);
    draw_discs(a, gl, m, m->vitreous, RELUME_EYE_VITREOUS);
    draw_strokes(a, gl, m, m->lashes, RELUME_EYE_LIDS);
    a->light = a->parts_off & RELUME_EYE_LIDS ? 1 : fmin(gl_aperture_light(m), 1);
}
