// micro.c - light gathered by small pictures of what surrounds each place, by compute shaders
#include "transport/micro.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// ---------------------------------------------------------------- programs

enum { NODE, SENT, ROOT, FIRST, SPACING, WHOLE, SITE, GATHER_COUNT = SITE + SITE_UNIFORMS };
static const char *const gather_uniforms[] = {"node",    "sent",  "root",    "first",
                                              "spacing", "whole", SITE_NAMES};
enum { B_SPACING, B_EYE, BY_PART, B_SITE, BETWEEN_COUNT = B_SITE + SITE_UNIFORMS };
static const char *const between_uniforms[] = {"spacing", "eye", "by_part", SITE_NAMES};

relume_status micro_create(struct micro *m, const struct gl *gl, const struct relume_log *log)
{
    *m = (struct micro){.gl = gl, .log = log};
    const relume_status status = program_create_compute(&m->between, gl, "transport_between.comp",
                                                        NULL, between_uniforms, BETWEEN_COUNT, log);
    if (status)
        micro_destroy(m);
    return status;
}

void micro_destroy(struct micro *m)
{
    if (!m->gl)
        return;
    program_destroy(&m->gather, m->gl);
    program_destroy(&m->between, m->gl);
    m->gl->DeleteBuffers(1, &m->picture);
    m->gl->DeleteBuffers(1, &m->list);
    *m = (struct micro){.gl = NULL};
}

// ---------------------------------------------------------------- pictures

// The mean position of a pixel within the disc, and the part of it there.
static void put_pixel(float to[4], double x, double y, double size)
{
    enum { FINE = 16 };
    double at[2] = {0.0, 0.0};
    int n = 0;
    for (int i = 0; i < FINE * FINE; i++) {
        const double u = x + (i % FINE + 0.5) / FINE * size, v = y + (i / FINE + 0.5) / FINE * size;
        if (u * u + v * v >= 1.0)
            continue;
        at[0] += u, at[1] += v;
        n++;
    }
    to[0] = n ? (float)(at[0] / n) : 0.0f, to[1] = n ? (float)(at[1] / n) : 0.0f;
    to[2] = 0.0f, to[3] = (float)n / (FINE * FINE);
}

static relume_status make_picture(struct micro *m, int side)
{
    const int pixels = side * side;
    float(*pixel)[4] = malloc((size_t)pixels * sizeof *pixel);
    char defines[64];
    if (!pixel)
        return RELUME_ENOMEM;
    m->whole = 0.0f;
    for (int i = 0; i < pixels; i++) {
        put_pixel(pixel[i], 2.0 * (i % side) / side - 1.0, 2.0 * (i / side) / side - 1.0,
                  2.0 / side);
        m->whole += pixel[i][3];
    }
    m->gl->DeleteBuffers(1, &m->picture);
    m->picture = gl_storage(m->gl, (size_t)pixels * sizeof *pixel, pixel);
    free(pixel);
    program_destroy(&m->gather, m->gl);
    snprintf(defines, sizeof defines, "#define SIDE %d\n#define PIXELS %d\n", side, pixels);
    const relume_status status = program_create_compute(
        &m->gather, m->gl, "transport_micro.comp", defines, gather_uniforms, GATHER_COUNT, m->log);
    m->side = status ? 0 : side;
    return status;
}

relume_status micro_need(struct micro *m, int samples)
{
    const int wanted = (int)sqrt((double)samples);
    const int side = wanted < MICRO_LEAST ? MICRO_LEAST : wanted > MICRO_MOST ? MICRO_MOST : wanted;
    return side == m->side ? RELUME_OK : make_picture(m, side);
}

// ---------------------------------------------------------------- shaders

static void set_gather(const struct micro *m, const struct points_view *v,
                       const struct points_sites *s)
{
    const struct gl *gl = m->gl;
    const GLint *at = m->gather.at;
    gl->UseProgram(m->gather.id);
    gl_bind(gl, 2, m->picture);
    gl_bind(gl, 3, m->list);
    points_use_sites(gl, at + SITE, v, s);
    texture_use(gl, 2, GL_TEXTURE_BUFFER, v->points->node_texels);
    gl->Uniform1i(at[NODE], 2);
    texture_use(gl, 3, GL_TEXTURE_BUFFER, v->points->sent_texels);
    gl->Uniform1i(at[SENT], 3);
    gl->Uniform3i(at[ROOT], v->points->first[CARD_SCENE], v->points->first[CARD_OBJECTS],
                  v->points->first[CARD_BACKS]);
    gl->Uniform1f(at[WHOLE], m->whole);
}

static void gather_at_leaves(const struct micro *m, const struct point_light *light,
                             const struct points_view *v)
{
    int top;
    const struct points_sites sites = point_light_sites(&top, light, v);
    set_gather(m, v, &sites);
    m->gl->Uniform2i(m->gather.at[FIRST], 0, top);
    m->gl->Uniform1i(m->gather.at[SPACING], 1);
    m->gl->DispatchCompute((GLuint)sites.place->width, (GLuint)(sites.place->height - top), 1);
    points_wait(m->gl);
}

relume_status micro_light(struct micro *m, struct point_light *light, const struct points_view *v,
                          const struct points_lit *lit)
{
    relume_status status = micro_need(m, v->samples);
    if (!status)
        status = point_light_scene(light, v, lit);
    for (int i = 0; i < v->bounces && !status; i++) {
        gather_at_leaves(m, light, v);
        point_light_objects(light, v, lit);
    }
    return status ? status : gl_check(m->gl, "light of points", m->log);
}

// ---------------------------------------------------------------- pixels

static void need_list(struct micro *m, int pixels)
{
    const GLuint header[4] = {256, 0, 1, 0};  // as between.comp
    const size_t bytes = sizeof header + (size_t)pixels * sizeof(GLuint);
    if (m->listed < pixels) {
        m->gl->DeleteBuffers(1, &m->list);
        m->list = gl_storage(m->gl, bytes, NULL);
        m->listed = pixels;
    }
    m->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, m->list);
    m->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof header, header);
}

static void fill_between(const struct micro *m, const struct points_view *v,
                         const struct points_sites *s)
{
    enum { AT_ONCE = 8 };
    const struct gl *gl = m->gl;
    const GLint *at = m->between.at;
    gl->UseProgram(m->between.id);
    gl_bind(gl, 3, m->list);
    points_use_sites(gl, at + B_SITE, v, s);
    gl->Uniform1i(at[B_SPACING], v->spacing);
    gl_set_vec3(gl, at[B_EYE], v->eye);
    gl->Uniform1i(at[BY_PART], s->of_scene);
    gl->DispatchCompute((GLuint)((s->place->width + AT_ONCE - 1) / AT_ONCE),
                        (GLuint)((s->place->height + AT_ONCE - 1) / AT_ONCE), 1);
    points_wait(gl);
}

void micro_gather(struct micro *m, const struct points_view *v, const struct points_sites *s)
{
    const struct gl *gl = m->gl;
    const int width = s->place->width, height = s->place->height, spacing = v->spacing;
    const int first = spacing / 2;
    need_list(m, width * height);
    set_gather(m, v, s);
    gl->Uniform2i(m->gather.at[FIRST], first, first);
    gl->Uniform1i(m->gather.at[SPACING], spacing);
    gl->DispatchCompute((GLuint)((width - first + spacing - 1) / spacing),
                        (GLuint)((height - first + spacing - 1) / spacing), 1);
    points_wait(gl);
    if (spacing < 2)
        return;
    fill_between(m, v, s);
    set_gather(m, v, s);
    gl->Uniform1i(m->gather.at[SPACING], 0);
    gl->BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, m->list);
    gl->DispatchComputeIndirect(0);
    gl->BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
    points_wait(gl);
}
