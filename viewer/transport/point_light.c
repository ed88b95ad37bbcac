// point_light.c - what trees of points send under a light, by compute shaders
#include "transport/point_light.h"
#include "world/object/object_points.h"

enum { AT_ONCE = 64 };  // of a work group

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
    BALL,
    LEAVES_COUNT
};
static const char *const leaves_uniforms[] = {"panorama", "mean",    "let_without", "let_with",
                                              "gathered", "range",   "of_scene",    "layout_of",
                                              "sends",    "returns", "ball"};
enum { UP_RANGE, UP_COUNT };
static const char *const up_uniforms[] = {"range"};

relume_status point_light_create(struct point_light *p, const struct gl *gl,
                                 const struct relume_log *log)
{
    const struct compute_shader list[] = {
        {&p->leaves, "transport_leaves.comp", leaves_uniforms, LEAVES_COUNT},
        {&p->up, "transport_up.comp", up_uniforms, UP_COUNT},
    };
    *p = (struct point_light){.gl = gl, .log = log};
    const relume_status status = program_create_shaders(list, sizeof list / sizeof *list, gl, log);
    if (status)
        point_light_destroy(p);
    return status;
}

void point_light_destroy(struct point_light *p)
{
    if (!p->gl)
        return;
    program_destroy(&p->leaves, p->gl);
    program_destroy(&p->up, p->gl);
    target_destroy(&p->gathered, p->gl);
    target_destroy(&p->unused, p->gl);
    *p = (struct point_light){.gl = NULL};
}

// ---------------------------------------------------------------- sites

static void use_texture(const struct gl *gl, GLint at, int unit, const struct target *target)
{
    texture_use(gl, unit, GL_TEXTURE_2D, target->texture);
    gl->Uniform1i(at, unit);
}

void points_use_sites(const struct gl *gl, const GLint *at, const struct points_view *v,
                      const struct points_sites *s)
{
    const double DEPTH = 0.005, SURFACE = 1e-4;  // as scenery_leave; of the radius
    const GLuint image[] = {s->without->texture, s->with_objects->texture};
    for (GLuint i = 0; i < 2; i++)
        gl->BindImageTexture(i, image[i], 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
    use_texture(gl, at[SITE_PLACE], 0, s->place);
    use_texture(gl, at[SITE_FACING], 1, s->facing);
    gl->Uniform2f(at[SITE_KIND], s->kind - 0.5f, s->kind + 0.5f);
    gl->Uniform4f(at[SITE_CENTRE], (float)v->centre.x, (float)v->centre.y, (float)v->centre.z,
                  s->of_scene ? (float)DEPTH : 0.0f);
    gl->Uniform1f(at[SITE_OFF], s->of_scene ? 0.0f : (float)(SURFACE * v->radius));
}

void points_wait(const struct gl *gl)
{
    gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                      GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                      GL_COMMAND_BARRIER_BIT);
}

struct points_sites point_light_sites(int *top, const struct point_light *p,
                                      const struct points_view *v)
{
    target_begin(&p->gathered, p->gl);
    *top = v->points->of_scene / v->points->leaf_place.width;
    return (struct points_sites){.place = &v->points->leaf_place,
                                 .facing = &v->points->leaf_facing,
                                 .kind = 2.0f,
                                 .without = &p->unused,
                                 .with_objects = &p->gathered};
}

// ---------------------------------------------------------------- shaders

static GLuint groups_of(int count)
{
    return (GLuint)((count + AT_ONCE - 1) / AT_ONCE);
}

static void send_up(const struct point_light *p, const struct points_view *v, int tree)
{
    const struct gl *gl = p->gl;
    const struct relume_points *t = &v->points->tree[tree];
    gl->UseProgram(p->up.id);
    gl_bind(gl, 0, v->points->node);
    gl_bind(gl, 1, v->points->sent);
    for (int l = t->levels - 2; l >= 0; l--) {
        const int first = v->points->first[tree] + (int)t->first[l];
        const int end = v->points->first[tree] + (int)t->first[l + 1];
        gl->Uniform2i(p->up.at[UP_RANGE], first, end);
        gl->DispatchCompute(groups_of(end - first), 1, 1);
        points_wait(gl);
    }
}

// `part` of what objects return and send counts.
static void light_leaves(const struct point_light *p, const struct points_view *v,
                         const struct points_lit *lit, int first, int end, float part)
{
    const struct gl *gl = p->gl;
    const GLint *at = p->leaves.at;
    if (first >= end)
        return;
    gl->UseProgram(p->leaves.id);
    gl_bind(gl, 0, v->points->node);
    gl_bind(gl, 1, v->points->sent);
    gl_bind(gl, 2, v->points->leaf);
    gl_bind(gl, 3, v->points->block);
    use_texture(gl, at[PANORAMA], 0, lit->panorama);
    use_texture(gl, at[MEAN], 1, lit->mean);
    use_texture(gl, at[LET_WITHOUT], 2, lit->let_without);
    use_texture(gl, at[LET_WITH], 3, lit->let_with);
    use_texture(gl, at[GATHERED], 4, &p->gathered);
    gl->Uniform1i(at[OF_SCENE], v->points->of_scene);
    gl->Uniform2i(at[LAYOUT], v->points->tree[CARD_SCENE].across, v->points->tree[CARD_SCENE].side);
    gl->Uniform1f(at[SENDS], part * v->sends);
    gl->Uniform1f(at[RETURNS], part);
    gl->Uniform4f(at[BALL], (float)v->middle.x, (float)v->middle.y, (float)v->middle.z,
                  (float)v->radius);
    gl->Uniform2i(at[LEAVES_RANGE], first, end);
    gl->DispatchCompute(groups_of(end - first), 1, 1);
    points_wait(gl);
}

static void send_from_objects(const struct point_light *p, const struct points_view *v,
                              const struct points_lit *lit, float part)
{
    light_leaves(p, v, lit, v->points->of_scene, v->points->leaves, part);
    send_up(p, v, CARD_OBJECTS);
    send_up(p, v, CARD_BACKS);
}

static relume_status need_gathered(struct point_light *p, const struct target *like)
{
    if (p->gathered.width == like->width && p->gathered.height == like->height)
        return RELUME_OK;
    target_destroy(&p->gathered, p->gl);
    target_destroy(&p->unused, p->gl);
    const relume_status status =
        target_create(&p->gathered, p->gl, like->width, like->height, p->log);
    return status ? status : target_create(&p->unused, p->gl, like->width, like->height, p->log);
}

relume_status point_light_scene(struct point_light *p, const struct points_view *v,
                                const struct points_lit *lit)
{
    const relume_status status = need_gathered(p, &v->points->leaf_place);
    if (status)
        return status;
    light_leaves(p, v, lit, 0, v->points->of_scene, 1.0f);
    send_up(p, v, CARD_SCENE);
    send_from_objects(p, v, lit, 0.0f);
    return RELUME_OK;
}

void point_light_objects(const struct point_light *p, const struct points_view *v,
                         const struct points_lit *lit)
{
    send_from_objects(p, v, lit, 1.0f);
}
