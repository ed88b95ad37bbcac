// micro.c - light gathered by small pictures of what surrounds each place, by compute passes
#include "transport/micro.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// ---------------------------------------------------------------- programs

enum { NODE, SENT, PLACE, FACING, KIND, ROOT, FIRST, SPACING, CENTRE, OFF, WHOLE, GATHER_COUNT };
static const char *const gather_uniforms[] = {"node",   "sent", "place", "facing",
                                              "kind",   "root", "first", "spacing",
                                              "centre", "off",  "whole"};
enum {
    PANORAMA,
    MEAN,
    LET_WITHOUT,
    LET_WITH,
    GATHERED,
    LEAVES_RANGE,
    OF_SCENE,
    LAYOUT,
    SENDS,
    RETURNS,
    LEAVES_COUNT
};
static const char *const leaves_uniforms[] = {"panorama", "mean",   "let_without", "let_with",
                                              "gathered", "range",  "of_scene",    "layout_of",
                                              "sends",    "returns"};
enum { UP_RANGE, UP_COUNT };
static const char *const up_uniforms[] = {"range"};
enum { B_PLACE, B_FACING, B_KIND, B_SPACING, B_EYE, BY_PART, BETWEEN_COUNT };
static const char *const between_uniforms[] = {"place",   "facing", "kind",
                                               "spacing", "eye",    "by_part"};

relume_status micro_create(struct micro *m, const struct gl *gl, const struct relume_log *log)
{
    const struct compute_pass list[] = {
        {&m->leaves, "transport_leaves.comp", leaves_uniforms, LEAVES_COUNT},
        {&m->up, "transport_up.comp", up_uniforms, UP_COUNT},
        {&m->between, "transport_between.comp", between_uniforms, BETWEEN_COUNT},
    };
    *m = (struct micro){.gl = gl, .log = log};
    const relume_status status = program_create_passes(list, sizeof list / sizeof *list, gl, log);
    if (status)
        micro_destroy(m);
    return status;
}

void micro_destroy(struct micro *m)
{
    if (!m->gl)
        return;
    struct program *const programs[] = {&m->gather, &m->leaves, &m->up, &m->between};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        program_destroy(programs[i], m->gl);
    m->gl->DeleteBuffers(1, &m->picture);
    m->gl->DeleteBuffers(1, &m->list);
    target_destroy(&m->gathered, m->gl);
    target_destroy(&m->unused, m->gl);
    *m = (struct micro){.gl = NULL};
}

// ---------------------------------------------------------------- pictures

// The mean place of a pixel within the disc, and the part of it there. Twin: measure.
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
    m->side = side;
    return program_create_compute(&m->gather, m->gl, "transport_micro.comp", defines,
                                  gather_uniforms, GATHER_COUNT, m->log);
}

static relume_status need_picture(struct micro *m, const struct micro_view *v)
{
    const int wanted = (int)sqrt((double)v->samples);
    const int side = wanted < MICRO_LEAST ? MICRO_LEAST : wanted > MICRO_MOST ? MICRO_MOST : wanted;
    return side == m->side ? RELUME_OK : make_picture(m, side);
}

// ---------------------------------------------------------------- passes

static void use(const struct micro *m, GLint at, int unit, const struct target *target)
{
    texture_use(m->gl, unit, GL_TEXTURE_2D, target->texture);
    m->gl->Uniform1i(at, unit);
}

static void use_images(const struct micro *m, const struct target *without,
                       const struct target *with_objects)
{
    m->gl->BindImageTexture(0, without->texture, 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
    m->gl->BindImageTexture(1, with_objects->texture, 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
}

static void wait_for_pass(const struct micro *m)
{
    m->gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                         GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                         GL_COMMAND_BARRIER_BIT);
}

static void set_gather(const struct micro *m, const struct micro_view *v,
                       const struct micro_sites *s)
{
    const struct gl *gl = m->gl;
    const GLint *at = m->gather.at;
    const double DEPTH = 0.005, SURFACE = 1e-4;  // as scenery_leave; of the radius
    gl->UseProgram(m->gather.id);
    gl_bind(gl, 2, m->picture);
    gl_bind(gl, 3, m->list);
    use_images(m, s->without, s->with_objects);
    use(m, at[PLACE], 0, s->place);
    use(m, at[FACING], 1, s->facing);
    texture_use(gl, 2, GL_TEXTURE_BUFFER, v->points->node_texels);
    gl->Uniform1i(at[NODE], 2);
    texture_use(gl, 3, GL_TEXTURE_BUFFER, v->points->sent_texels);
    gl->Uniform1i(at[SENT], 3);
    gl->Uniform2f(at[KIND], s->kind - 0.5f, s->kind + 0.5f);
    gl->Uniform3i(at[ROOT], v->points->first[CARD_SCENE], v->points->first[CARD_OBJECTS],
                  v->points->first[CARD_BACKS]);
    gl->Uniform4f(at[CENTRE], (float)v->centre.x, (float)v->centre.y, (float)v->centre.z,
                  s->of_scene ? (float)DEPTH : 0.0f);
    gl->Uniform1f(at[OFF], s->of_scene ? 0.0f : (float)(SURFACE * v->radius));
    gl->Uniform1f(at[WHOLE], m->whole);
}

static void run_leaves(const struct micro *m, int first, int end)
{
    enum { AT_ONCE = 64 };
    if (first >= end)
        return;
    m->gl->Uniform2i(m->leaves.at[LEAVES_RANGE], first, end);
    m->gl->DispatchCompute((GLuint)((end - first + AT_ONCE - 1) / AT_ONCE), 1, 1);
    wait_for_pass(m);
}

static void send_up(const struct micro *m, const struct micro_view *v, int tree)
{
    enum { AT_ONCE = 64 };
    const struct relume_points *p = &v->points->tree[tree];
    m->gl->UseProgram(m->up.id);
    gl_bind(m->gl, 0, v->points->node);
    gl_bind(m->gl, 1, v->points->sent);
    for (int l = p->levels - 2; l >= 0; l--) {
        const int first = v->points->first[tree] + (int)p->first[l];
        const int end = v->points->first[tree] + (int)p->first[l + 1];
        m->gl->Uniform2i(m->up.at[UP_RANGE], first, end);
        m->gl->DispatchCompute((GLuint)((end - first + AT_ONCE - 1) / AT_ONCE), 1, 1);
        wait_for_pass(m);
    }
}

// Leaves of objects gather, whose rows of the texture come last.
static void gather_at_leaves(const struct micro *m, const struct micro_view *v)
{
    const struct target *place = &v->points->leaf_place;
    const int top = v->points->of_scene / place->width;
    const struct micro_sites sites = {.place = place,
                                      .facing = &v->points->leaf_facing,
                                      .kind = 2.0f,
                                      .without = &m->unused,
                                      .with_objects = &m->gathered};
    set_gather(m, v, &sites);
    m->gl->Uniform2i(m->gather.at[FIRST], 0, top);
    m->gl->Uniform1i(m->gather.at[SPACING], 1);
    m->gl->DispatchCompute((GLuint)place->width, (GLuint)(place->height - top), 1);
    wait_for_pass(m);
}

static relume_status need_gathered(struct micro *m, const struct target *like)
{
    if (m->gathered.width == like->width && m->gathered.height == like->height)
        return RELUME_OK;
    target_destroy(&m->gathered, m->gl);
    target_destroy(&m->unused, m->gl);
    const relume_status status =
        target_create(&m->gathered, m->gl, like->width, like->height, m->log);
    return status ? status : target_create(&m->unused, m->gl, like->width, like->height, m->log);
}

static void use_leaves(const struct micro *m, const struct micro_view *v,
                       const struct target *const from[4])
{
    const struct gl *gl = m->gl;
    const GLint *at = m->leaves.at;
    gl->UseProgram(m->leaves.id);
    gl_bind(gl, 1, v->points->sent);
    gl_bind(gl, 2, v->points->leaf);
    gl_bind(gl, 3, v->points->block);
    for (int i = 0; i < 4; i++)
        use(m, at[PANORAMA + i], i, from[i]);
    use(m, at[GATHERED], 4, &m->gathered);
    gl->Uniform1i(at[OF_SCENE], v->points->of_scene);
    gl->Uniform2i(at[LAYOUT], v->points->tree[CARD_SCENE].across, v->points->tree[CARD_SCENE].side);
}

// `lit`: else they send nothing.
static void light_objects(const struct micro *m, const struct micro_view *v,
                          const struct target *const from[4], bool lit)
{
    use_leaves(m, v, from);
    m->gl->Uniform1f(m->leaves.at[SENDS], lit ? v->sends : 0.0f);
    m->gl->Uniform1f(m->leaves.at[RETURNS], lit ? 1.0f : 0.0f);
    run_leaves(m, v->points->of_scene, v->points->leaves);
    send_up(m, v, CARD_OBJECTS);
    send_up(m, v, CARD_BACKS);
}

relume_status micro_light(struct micro *m, const struct micro_view *v,
                          const struct target *panorama, const struct target *mean,
                          const struct target *let_without, const struct target *let_with)
{
    const struct target *const from[] = {panorama, mean, let_without, let_with};
    const struct card_points *p = v->points;
    relume_status status = need_gathered(m, &p->leaf_place);
    if (!status)
        status = need_picture(m, v);
    if (status)
        return status;
    use_leaves(m, v, from);
    run_leaves(m, 0, p->of_scene);
    send_up(m, v, CARD_SCENE);
    light_objects(m, v, from, false);
    for (int i = 0; i < v->bounces; i++) {
        target_begin(&m->gathered, m->gl);
        gather_at_leaves(m, v);
        light_objects(m, v, from, true);
    }
    return gl_check(m->gl, "light of points", m->log);
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

static void fill_between(const struct micro *m, const struct micro_view *v,
                         const struct micro_sites *s)
{
    enum { AT_ONCE = 8 };
    const struct gl *gl = m->gl;
    const GLint *at = m->between.at;
    gl->UseProgram(m->between.id);
    gl_bind(gl, 3, m->list);
    use_images(m, s->without, s->with_objects);
    use(m, at[B_PLACE], 0, s->place);
    use(m, at[B_FACING], 1, s->facing);
    gl->Uniform2f(at[B_KIND], s->kind - 0.5f, s->kind + 0.5f);
    gl->Uniform1i(at[B_SPACING], v->spacing);
    gl_set_vec3(gl, at[B_EYE], v->eye);
    gl->Uniform1i(at[BY_PART], s->of_scene);
    gl->DispatchCompute((GLuint)((s->place->width + AT_ONCE - 1) / AT_ONCE),
                        (GLuint)((s->place->height + AT_ONCE - 1) / AT_ONCE), 1);
    wait_for_pass(m);
}

void micro_gather(struct micro *m, const struct micro_view *v, const struct micro_sites *s)
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
    wait_for_pass(m);
    if (spacing < 2)
        return;
    fill_between(m, v, s);
    set_gather(m, v, s);
    gl->Uniform1i(m->gather.at[SPACING], 0);
    gl->BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, m->list);
    gl->DispatchComputeIndirect(0);
    gl->BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
    wait_for_pass(m);
}
