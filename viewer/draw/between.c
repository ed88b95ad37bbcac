// between.c - light between a captured panorama and the objects in it, by passes over the frame.
// Twins: world/object/exchange.c, world/transport/screen.c, world/transport/smooth.c
#include "draw/between.h"

#include "cli/program/say.h"
#include "common/vec.h"
#include "draw/objects_drawer_parts.h"

#include <stdlib.h>
#include <string.h>

// Of the ball about the objects, the ball within which what is captured throws shadows on the
// scene.
static const double CAPTURED_RADII = 3.0;
enum { CAPTURED_SIDE = 2048, CAPTURED_SIDE_SOFTWARE = 512 };

// ---------------------------------------------------------------- programs

enum { BACK_CLIP, BACK_FRONT, BACK_GRID, BACK_EYE, BACK_COUNT };
static const char *const back_uniforms[] = {"clip", "front", "grid", "eye"};
enum { F_SCENE = DRAW_OWN, F_OBJECTS, F_NORMALS, F_BACK, F_GRID, F_EYE, FRONT_COUNT };
static const char *const front_uniforms[] = {"rectangle", "frame_size", "scene", "objects",
                                             "normals",   "back",       "grid",  "eye"};
enum {
    LAMPS_FACING = DRAW_OWN + 1,
    LAMPS_CENTRE,
    LAMPS_PICTURE,
    LAMPS_LIGHT,
    LAMPS_SHADOW = LAMPS_LIGHT + LIGHT_UNIFORMS,
    LAMPS_CAPTURED = LAMPS_SHADOW + SHADOW_UNIFORMS,
    LAMPS_COUNT = LAMPS_CAPTURED + SHADOW_UNIFORMS
};
static const char *const lamps_uniforms[] = {
    "rectangle",       "frame_size",     "scene",          "scene_facing", "centre",
    "picture",         LIGHT_NAMES,      SHADOW_NAMES,     "captured",     "captured_clip",
    "captured_layers", "captured_light", "captured_texel",
};
enum { VIEW = DRAW_OWN, ELEVATION, DISC, MEAN_COUNT };
static const char *const mean_uniforms[] = {"rectangle", "frame_size", "view", "elevation", "disc"};
enum {
    SHOWN_FRONT = DRAW_OWN,
    SHOWN_OBJECTS,
    SHADED,
    LONE,
    LET_WITHOUT,
    LET_WITH,
    MEAN,
    SHOWN_GRID,
    SHOWN_EMITTED,
    SHOWN_SENDS,
    SHOWN_COUNT
};
static const char *const shown_uniforms[] = {"rectangle", "frame_size", "front",       "objects",
                                             "shaded",    "lone",       "let_without", "let_with",
                                             "mean",      "grid",       "emitted",     "sends"};
enum {
    G_PLACES = MEAN_COUNT,
    G_CENTRE,
    G_SCENE,
    G_SCENE_FACING,
    G_FRONT,
    G_FACING,
    G_SHOWN,
    G_LONE,
    G_MEAN,
    G_ALL_WITHOUT,
    G_ALL_WITH,
    G_MIDDLE,
    G_AT_OBJECTS,
    G_DIRECTIONAL,
    G_BOUNCES,
    G_SAMPLES,
    G_PATTERN,
    G_RADIUS,
    G_CLIP,
    G_EYE,
    GATHER_COUNT
};
static const char *const gather_uniforms[] = {
    "rectangle",   "frame_size",   "view",   "elevation",  "disc",        "places",  "centre",
    "scene",       "scene_facing", "front",  "facing",     "shown",       "lone",    "mean",
    "all_without", "all_with",     "middle", "at_objects", "directional", "bounces", "samples",
    "pattern",     "radius",       "clip",   "eye",
};
enum { FIRST = DRAW_OWN, SECOND, SMOOTH_PLACE, SMOOTH_FACING, SMOOTH_EYE, SIZE_OF, SMOOTH_COUNT };
static const char *const smooth_uniforms[] = {"rectangle", "frame_size", "first", "second",
                                              "place",     "facing",     "eye",   "size"};
enum {
    RETURNED_FRONT = DRAW_OWN,
    GATHERED,
    RETURNED_OBJECTS,
    WHITE,
    RETURNED_GRID,
    RETURNED_COUNT
};
static const char *const returned_uniforms[] = {"rectangle", "frame_size", "front", "gathered",
                                                "objects",   "white",      "grid"};
enum {
    S_SCENE = DRAW_OWN,
    S_LONE,
    S_LET_WITHOUT,
    S_LET_WITH,
    S_ALL_WITHOUT,
    S_ALL_WITH,
    S_WITHOUT,
    S_WITH,
    S_EXPOSURE,
    SCENE_COUNT
};
static const char *const scene_uniforms[] = {
    "rectangle",   "frame_size", "scene",   "lone",         "let_without", "let_with",
    "all_without", "all_with",   "without", "with_objects", "exposure"};

static relume_status create_programs(struct between *b, const struct relume_geometry *geometry)
{
    const struct gl *gl = b->gl;
    const struct {
        struct program *program;
        const char *name, *const *uniforms;
        int count;
    } list[] = {
        {&b->front, "between_front.frag", front_uniforms, FRONT_COUNT},
        {&b->lamps, "between_lamps.frag", lamps_uniforms, LAMPS_COUNT},
        {&b->shown, "between_shown.frag", shown_uniforms, SHOWN_COUNT},
        {&b->smooth, "between_smooth.frag", smooth_uniforms, SMOOTH_COUNT},
        {&b->returned, "between_returned.frag", returned_uniforms, RETURNED_COUNT},
        {&b->scene, "between_scene.frag", scene_uniforms, SCENE_COUNT},
    };
    const char *panorama = draw_panorama_shader(geometry);
    relume_status status = program_create_with(
        &b->back, gl, "btf_surface.vert", "between_back.frag", back_uniforms, BACK_COUNT, b->log);
    for (size_t i = 0; i < sizeof list / sizeof *list && !status; i++)
        status = program_create(list[i].program, gl, list[i].name, list[i].uniforms, list[i].count,
                                b->log);
    if (!status)
        status = program_create_variant(&b->mean, gl, panorama, "#define BETWEEN\n#define MEAN\n",
                                        mean_uniforms, MEAN_COUNT, b->log);
    return status ? status
                  : program_create_variant(&b->gather, gl, panorama, "#define BETWEEN\n",
                                           gather_uniforms, GATHER_COUNT, b->log);
}

// Light of 1 from everywhere.
static relume_status make_white_sky(struct between *b)
{
    enum { WIDE = 8, HIGH = 4 };
    relume_status status = relume_image_create(&b->white_map, WIDE, HIGH, 3);
    for (int i = 0; i < 3 * WIDE * HIGH && !status; i++)
        b->white_map.data[i] = 1.0f;
    return status ? status : relume_environment_create(&b->white_sky, &b->white_map, NULL);
}

// ---------------------------------------------------------------- targets

static void joined_destroy(struct joined *j, const struct gl *gl)
{
    for (int i = 0; i < j->count; i++)
        target_destroy(&j->target[i], gl);
    gl->DeleteFramebuffers(1, &j->framebuffer);
    *j = (struct joined){.count = 0};
}

static relume_status joined_create(struct joined *j, const struct between *b, int count, int width,
                                   int height)
{
    const struct gl *gl = b->gl;
    GLenum buffers[BETWEEN_JOINED];
    relume_status status = RELUME_OK;
    joined_destroy(j, gl);
    for (; j->count < count && !status; j->count++)
        status = target_create(&j->target[j->count], gl, width, height, b->log);
    if (status)
        return status;
    gl->GenFramebuffers(1, &j->framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, j->framebuffer);
    for (int i = 0; i < count; i++) {
        buffers[i] = GL_COLOR_ATTACHMENT0 + (GLenum)i;
        gl->FramebufferTexture2D(GL_FRAMEBUFFER, buffers[i], GL_TEXTURE_2D, j->target[i].texture,
                                 0);
    }
    gl->DrawBuffers(count, buffers);
    if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE)
        return gl_check(gl, "light between objects and scene", b->log);
    return say(b->log, RELUME_ESYSTEM, "OpenGL: cannot draw %d float pictures at once", count);
}

static void joined_begin(const struct joined *j, const struct gl *gl)
{
    gl->BindFramebuffer(GL_FRAMEBUFFER, j->framebuffer);
    gl->Viewport(0, 0, j->target[0].width, j->target[0].height);
    gl->ClearColor(0, 0, 0, 0);
    gl->Clear(GL_COLOR_BUFFER_BIT);
}

// Depths of a target of their own.
static relume_status make_behind(struct between *b, int width, int height)
{
    const struct gl *gl = b->gl;
    relume_status status = target_create(&b->behind, gl, width, height, b->log);
    if (status)
        return status;
    gl->GenTextures(1, &b->behind_depth);
    texture_use(gl, 0, GL_TEXTURE_2D, b->behind_depth);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, width, height, 0, GL_DEPTH_COMPONENT,
                   GL_FLOAT, NULL);
    texture_settings(gl, GL_TEXTURE_2D);
    gl->BindFramebuffer(GL_FRAMEBUFFER, b->behind.framebuffer);
    gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, b->behind_depth,
                             0);
    return gl_check(gl, "light between objects and scene", b->log);
}

static void destroy_targets(struct between *b)
{
    struct joined *const joined[] = {&b->nearest, &b->by_lamps, &b->gathered, &b->smoothed};
    struct target *const single[] = {&b->behind, &b->show, &b->thrown, &b->white, &b->sum};
    for (size_t i = 0; i < sizeof joined / sizeof *joined; i++)
        joined_destroy(joined[i], b->gl);
    for (size_t i = 0; i < sizeof single / sizeof *single; i++)
        target_destroy(single[i], b->gl);
    b->gl->DeleteTextures(1, &b->behind_depth);
    b->behind_depth = 0;
    b->white_of = 0;
}

static relume_status need_targets(struct between *b, const struct objects_drawer *t, int width,
                                  int height)
{
    if (b->show.width == width && b->show.height == height)
        return RELUME_OK;
    destroy_targets(b);
    relume_status status = joined_create(&b->nearest, b, 3, width, height);
    if (!status)
        status = joined_create(&b->by_lamps, b, 4, width, height);
    if (!status)
        status = joined_create(&b->gathered, b, 2, width, height);
    if (!status)
        status = joined_create(&b->smoothed, b, 2, width, height);
    if (!status)
        status = make_behind(b, width, height);
    if (!status)
        status = target_create(&b->thrown, b->gl, width, height, b->log);
    if (!status)
        status = target_create(&b->white, b->gl, t->surface.position.width,
                               t->surface.position.height, b->log);
    if (!status)
        status = target_create(&b->sum, b->gl, t->surface.position.width,
                               t->surface.position.height, b->log);
    return status ? status : target_create(&b->show, b->gl, width, height, b->log);
}

void between_destroy(struct between *b)
{
    if (!b->gl)
        return;
    struct program *const programs[] = {&b->back,  &b->front,  &b->lamps,  &b->mean,
                                        &b->shown, &b->gather, &b->smooth, &b->returned,
                                        &b->scene, &b->picture};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        program_destroy(programs[i], b->gl);
    destroy_targets(b);
    target_destroy(&b->even, b->gl);
    joined_destroy(&b->leaf_lamps, b->gl);
    point_light_destroy(&b->point_light);
    micro_destroy(&b->micro);
    ism_destroy(&b->ism);
    card_points_destroy(&b->points);
    captured_mesh_destroy(&b->mesh);
    shadow_map_destroy(&b->captured);
    light_uniforms_forget(&b->uniforms);
    b->gl->DeleteVertexArrays(1, &b->array);
    relume_environment_destroy(&b->white_sky);
    relume_image_destroy(&b->white_map);
    *b = (struct between){.gl = NULL};
}

relume_status between_create(struct between *b, const struct gl *gl,
                             const struct relume_geometry *geometry, const struct target *places,
                             const struct relume_log *log)
{
    const int side = gl->software ? CAPTURED_SIDE_SOFTWARE : CAPTURED_SIDE;
    *b = (struct between){.gl = gl, .log = log, .uniforms = {.gl = gl, .log = log}};
    gl->GenVertexArrays(1, &b->array);
    relume_status status = create_programs(b, geometry);
    if (!status)
        status = program_create_fragment(&b->picture, gl, &draw_picture_fragment, log);
    if (!status)
        status = captured_mesh_create(&b->mesh, gl, geometry, places, log);
    if (!status)
        status = shadow_map_create(&b->captured, gl, side, log);
    if (!status)
        status = target_create(&b->even, gl, 1, 1, log);
    if (!status)
        status = make_white_sky(b);
    if (!status)  // whether so many can be drawn at once
        status = joined_create(&b->by_lamps, b, BETWEEN_JOINED, 1, 1);
    if (status)
        between_destroy(b);
    return status;
}

// ---------------------------------------------------------------- passes

// Texture `unit` of the program in use.
static void use(const struct between *b, GLint at, int unit, const struct target *target)
{
    texture_use(b->gl, unit, GL_TEXTURE_2D, target->texture);
    b->gl->Uniform1i(at, unit);
}

static void use_eye(const struct between *b, GLint at, const struct between_view *v)
{
    const float *eye = v->projection->eye;
    b->gl->Uniform4f(at, eye[0], eye[1], eye[2], eye[3]);
}

static void draw_onto(const struct between *b, const struct program *program,
                      const struct target *onto)
{
    const struct frame_area area = {.width = onto->width, .height = onto->height};
    b->gl->BindVertexArray(b->array);
    draw_whole(b->gl, program, &area);
}

static void draw_added(const struct between *b, const struct program *program,
                       const struct target *onto)
{
    b->gl->Enable(GL_BLEND);
    b->gl->BlendFunc(GL_ONE, GL_ONE);
    draw_onto(b, program, onto);
    b->gl->Disable(GL_BLEND);
}

static void find_backs(const struct between *b, const struct objects_drawer *t,
                       const struct between_view *v)
{
    const struct gl *gl = b->gl;
    target_resume(&b->behind, gl);
    gl->ClearColor(0, 0, 0, 0);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl->UseProgram(b->back.id);
    gl->UniformMatrix4fv(b->back.at[BACK_CLIP], 1, GL_FALSE, v->projection->clip);
    use(b, b->back.at[BACK_FRONT], 0, &t->surface.position);
    gl->Uniform1i(b->back.at[BACK_GRID], t->surface.grid);
    use_eye(b, b->back.at[BACK_EYE], v);
    gl->BindVertexArray(t->mesh.array);
    gl->Enable(GL_DEPTH_TEST);
    gl->DrawElements(GL_TRIANGLES,
                     (GLsizei)(3 * object_mesh_drawn(&t->mesh, t->objects)->triangle_count),
                     GL_UNSIGNED_INT, NULL);
    gl->Disable(GL_DEPTH_TEST);
}

static void find_nearest(const struct between *b, const struct objects_drawer *t,
                         const struct between_view *v)
{
    const GLint *at = b->front.at;
    joined_begin(&b->nearest, b->gl);
    b->gl->UseProgram(b->front.id);
    use(b, at[F_SCENE], 0, v->scene);
    use(b, at[F_OBJECTS], 1, &t->surface.position);
    use(b, at[F_NORMALS], 2, &t->surface.normal);
    use(b, at[F_BACK], 3, &b->behind);
    b->gl->Uniform1i(at[F_GRID], t->surface.grid);
    use_eye(b, at[F_EYE], v);
    draw_onto(b, &b->front, &b->show);
}

// Which materials are shown.
static uint64_t fingerprint(const struct objects_drawer *t)
{
    const struct relume_objects_info *info = relume_objects_info(t->objects);
    uint64_t sum = 1;
    for (int i = 0; i < info->parts; i++)
        sum = sum * 1000003u + (uint64_t)info->part[i].material + 1;
    return sum;
}

// The objects under a white sky, while eye and materials are the same.
static relume_status need_white(struct between *b, struct objects_drawer *t,
                                const struct between_view *v)
{
    const struct relume_light white = {
        .kind = RELUME_LIGHT_ENVIRONMENT, .rgb = {1, 1, 1}, .environment = b->white_sky};
    const uint64_t of = fingerprint(t);
    if (b->white_of == of && !memcmp(b->white_clip, v->projection->clip, sizeof b->white_clip))
        return RELUME_OK;
    const relume_status status = objects_drawer_show_sky(t, &white);
    if (status)
        return status;
    const struct target shown = t->sky.shown;
    t->sky.shown = b->white;
    b->white = shown;
    b->white_of = of;
    memcpy(b->white_clip, v->projection->clip, sizeof b->white_clip);
    return RELUME_OK;
}

// Ways that gather from points.
static bool has_points(enum between_way way)
{
    return way >= BETWEEN_MICRO;
}

static relume_status need_way(struct between *b, enum between_way way, int samples)
{
    relume_status status =
        b->point_light.gl ? RELUME_OK : point_light_create(&b->point_light, b->gl, b->log);
    if (!status && way == BETWEEN_MICRO && !b->micro.gl)
        status = micro_create(&b->micro, b->gl, b->log);
    if (!status && way == BETWEEN_ISM && !b->ism.gl)
        status = ism_create(&b->ism, b->gl, b->log);
    if (status)
        return status;
    return way == BETWEEN_ISM ? ism_need(&b->ism, samples) : micro_need(&b->micro, samples);
}

relume_status between_need(struct between *b, const struct objects_drawer *t,
                           const struct relume_geometry *geometry, const struct target *places,
                           enum between_way way, int samples)
{
    if (!has_points(way))
        return RELUME_OK;
    relume_status status = need_way(b, way, samples);
    if (!status)
        status = card_points_need(&b->points, b->gl, geometry, places, t->objects, fingerprint(t),
                                  b->log);
    const struct target *leaf = &b->points.leaf_place;
    if (status || (b->leaf_lamps.count && b->leaf_lamps.target[0].width == leaf->width &&
                   b->leaf_lamps.target[0].height == leaf->height))
        return status;
    return joined_create(&b->leaf_lamps, b, BETWEEN_JOINED, leaf->width, leaf->height);
}

relume_status between_begin(struct between *b, struct objects_drawer *t,
                            const struct between_view *v)
{
    const struct relume_light none = {.rgb = {0, 0, 0}};
    relume_status status = objects_drawer_light(t, &none, 0);
    if (!status)
        status = objects_drawer_shade(t, v->projection, v->width, v->height, -1);
    if (!status)
        status = need_targets(b, t, v->width, v->height);
    if (!status)
        status = need_white(b, t, v);
    if (status)
        return status;
    status = between_need(b, t, v->geometry, v->panorama_places, v->way, v->samples);
    if (status)
        return status;
    find_backs(b, t, v);
    find_nearest(b, t, v);
    target_begin(&b->thrown, b->gl);
    target_begin(&b->sum, b->gl);
    b->lights = 0;
    return RELUME_OK;
}

static void draw_captured(void *context, const float clip[16])
{
    captured_mesh_draw(context, clip);
}

// Adds a lamp, whose maps are drawn, at those places.
static relume_status add_lamp_at(struct between *b, const struct objects_drawer *t,
                                 const struct between_view *v, int number,
                                 const struct target *place, const struct target *facing,
                                 const struct joined *onto)
{
    const struct gl *gl = b->gl;
    const GLint *at = b->lamps.at;
    const struct relume_light light = object_lights_of(&t->lights.sample[number]);
    gl->BindFramebuffer(GL_FRAMEBUFFER, onto->framebuffer);
    gl->Viewport(0, 0, onto->target[0].width, onto->target[0].height);
    gl->UseProgram(b->lamps.id);
    use(b, at[DRAW_OWN], 0, place);
    use(b, at[LAMPS_FACING], 1, facing);
    gl_set_vec3(gl, at[LAMPS_CENTRE], v->geometry->center);
    gl->Uniform1i(at[LAMPS_PICTURE], 2);
    const relume_status status = light_uniforms_set(&b->uniforms, at + LAMPS_LIGHT, 2, &light);
    if (t->lights.sample[number].is_patch)
        gl_set_vec3(gl, at[LAMPS_LIGHT + LIGHT_AXIS], t->lights.sample[number].patch.normal);
    shadow_map_use(&t->shadows.map, gl, at + LAMPS_SHADOW, 3);
    shadow_map_use(&b->captured, gl, at + LAMPS_CAPTURED, 4);
    draw_added(b, &b->lamps, &onto->target[0]);
    return status;
}

static relume_status add_lamp(struct between *b, struct objects_drawer *t,
                              const struct between_view *v, int number)
{
    objects_drawer_draw_shadow(t, number);
    shadow_map_fill(&b->captured, &t->lights.sample[number], t->shadows.middle,
                    CAPTURED_RADII * t->shadows.radius, draw_captured, &b->mesh);
    const relume_status status =
        add_lamp_at(b, t, v, number, v->scene, &b->nearest.target[0], &b->by_lamps);
    if (status || !has_points(v->way))
        return status;
    return add_lamp_at(b, t, v, number, &b->points.leaf_place, &b->points.leaf_facing,
                       &b->leaf_lamps);
}

static void use_panorama(const struct between *b, const GLint *at, const struct between_view *v,
                         const struct target *panorama)
{
    use(b, at[VIEW], 0, panorama);
    b->gl->Uniform2f(at[ELEVATION], (float)v->geometry->v_min, (float)v->geometry->v_max);
    b->gl->Uniform1i(at[DISC], v->geometry->disc);
}

static void find_mean(const struct between *b, const struct between_view *v,
                      const struct target *panorama)
{
    target_begin(&b->even, b->gl);
    b->gl->UseProgram(b->mean.id);
    use_panorama(b, b->mean.at, v, panorama);
    draw_onto(b, &b->mean, &b->even);
}

static void show(const struct between *b, const struct objects_drawer *t,
                 const struct between_view *v, const struct target *lone)
{
    const GLint *at = b->shown.at;
    target_begin(&b->show, b->gl);
    b->gl->UseProgram(b->shown.id);
    use(b, at[SHOWN_FRONT], 0, &b->nearest.target[1]);
    use(b, at[SHOWN_OBJECTS], 1, &t->surface.position);
    use(b, at[SHADED], 2, &t->shaded);
    use(b, at[LONE], 3, lone);
    use(b, at[LET_WITHOUT], 4, &b->by_lamps.target[0]);
    use(b, at[LET_WITH], 5, &b->by_lamps.target[1]);
    use(b, at[MEAN], 6, &b->even);
    b->gl->Uniform1i(at[SHOWN_GRID], t->surface.grid);
    use(b, at[SHOWN_EMITTED], 7, &t->surface.emitted);
    b->gl->Uniform1f(at[SHOWN_SENDS], t->skins.sends ? v->sends : 0.0f);
    draw_onto(b, &b->shown, &b->show);
}

static void gather(const struct between *b, const struct objects_drawer *t,
                   const struct between_view *v, const struct target *panorama,
                   const struct target *lone, bool at_objects)
{
    const struct gl *gl = b->gl;
    const GLint *at = b->gather.at;
    joined_begin(&b->gathered, gl);
    gl->UseProgram(b->gather.id);
    use_panorama(b, at, v, panorama);
    use(b, at[G_PLACES], 1, v->panorama_places);
    gl_set_vec3(gl, at[G_CENTRE], v->geometry->center);
    use(b, at[G_SCENE], 2, v->scene);
    use(b, at[G_SCENE_FACING], 3, &b->nearest.target[0]);
    use(b, at[G_FRONT], 4, &b->nearest.target[1]);
    use(b, at[G_FACING], 5, &b->nearest.target[2]);
    use(b, at[G_SHOWN], 6, &b->show);
    use(b, at[G_LONE], 7, lone);
    use(b, at[G_MEAN], 8, &b->even);
    use(b, at[G_ALL_WITHOUT], 9, &b->by_lamps.target[2]);
    use(b, at[G_ALL_WITH], 10, &b->by_lamps.target[3]);
    gl_set_vec3(gl, at[G_MIDDLE], t->shadows.middle);
    gl->Uniform1i(at[G_AT_OBJECTS], at_objects);
    gl->Uniform1i(at[G_DIRECTIONAL], v->way == BETWEEN_DIRECTIONAL);
    gl->Uniform1i(at[G_BOUNCES], v->bounces > 0);
    gl->Uniform1i(at[G_SAMPLES], v->samples);
    gl->Uniform1i(at[G_PATTERN], v->pattern);
    gl->Uniform1f(at[G_RADIUS], (float)t->shadows.radius);
    gl->UniformMatrix4fv(at[G_CLIP], 1, GL_FALSE, v->projection->clip);
    use_eye(b, at[G_EYE], v);
    draw_onto(b, &b->gather, &b->show);
}

static struct points_view points_view(const struct between *b, const struct objects_drawer *t,
                                      const struct between_view *v)
{
    const float *eye = v->projection->eye;
    return (struct points_view){.points = &b->points,
                                .centre = v->geometry->center,
                                .eye = {(double)eye[0], (double)eye[1], (double)eye[2]},
                                .middle = t->shadows.middle,
                                .radius = t->shadows.radius,
                                .samples = v->samples,
                                .spacing = v->spacing,
                                .bounces = v->bounces,
                                .sends = v->sends};
}

// The alpha of places: of find_nearest 2 for objects, of the scene 1.
static void gather_from_points(struct between *b, const struct objects_drawer *t,
                               const struct between_view *v, bool at_objects)
{
    const struct points_view view = points_view(b, t, v);
    const struct points_sites sites = {.place = at_objects ? &b->nearest.target[1] : v->scene,
                                       .facing = &b->nearest.target[at_objects ? 2 : 0],
                                       .kind = at_objects ? 2.0f : 1.0f,
                                       .of_scene = !at_objects,
                                       .without = &b->gathered.target[0],
                                       .with_objects = &b->gathered.target[1]};
    joined_begin(&b->gathered, b->gl);
    if (v->way == BETWEEN_ISM)
        ism_gather(&b->ism, &view, &sites);
    else
        micro_gather(&b->micro, &view, &sites);
}

static void smooth(const struct between *b, const struct between_view *v, bool at_objects)
{
    const GLint *at = b->smooth.at;
    const float *eye = v->projection->eye;
    joined_begin(&b->smoothed, b->gl);
    b->gl->UseProgram(b->smooth.id);
    use(b, at[FIRST], 0, &b->gathered.target[0]);
    use(b, at[SECOND], 1, &b->gathered.target[1]);
    use(b, at[SMOOTH_PLACE], 2, at_objects ? &b->nearest.target[1] : v->scene);
    use(b, at[SMOOTH_FACING], 3, &b->nearest.target[at_objects ? 2 : 0]);
    b->gl->Uniform3f(at[SMOOTH_EYE], eye[0], eye[1], eye[2]);
    b->gl->Uniform1i(at[SIZE_OF], v->pattern);
    draw_onto(b, &b->smooth, &b->show);
}

static void throw_back(const struct between *b, const struct objects_drawer *t,
                       const struct target *onto)
{
    const GLint *at = b->returned.at;
    target_resume(onto, b->gl);
    b->gl->UseProgram(b->returned.id);
    use(b, at[RETURNED_FRONT], 0, &b->nearest.target[1]);
    use(b, at[GATHERED], 1, &b->smoothed.target[1]);
    use(b, at[RETURNED_OBJECTS], 2, &t->surface.position);
    use(b, at[WHITE], 3, &b->white);
    b->gl->Uniform1i(at[RETURNED_GRID], t->surface.grid);
    draw_added(b, &b->returned, onto);
}

static void add_scene(const struct between *b, const struct between_view *v,
                      const struct target *lone, const struct target *lit, float exposure)
{
    const GLint *at = b->scene.at;
    target_resume(lit, b->gl);
    b->gl->UseProgram(b->scene.id);
    use(b, at[S_SCENE], 0, v->scene);
    use(b, at[S_LONE], 1, lone);
    for (int i = 0; i < BETWEEN_JOINED; i++)
        use(b, at[S_LET_WITHOUT + i], 2 + i, &b->by_lamps.target[i]);
    use(b, at[S_WITHOUT], 6, &b->smoothed.target[0]);
    use(b, at[S_WITH], 7, &b->smoothed.target[1]);
    b->gl->Uniform1f(at[S_EXPOSURE], exposure);
    draw_added(b, &b->scene, lit);
}

// The first light is the sum; others are added to it.
static void add_shaded(struct between *b, struct objects_drawer *t)
{
    const struct target shaded = t->shaded;
    if (b->lights++ == 0) {
        t->shaded = b->sum;
        b->sum = shaded;
        return;
    }
    const int width = shaded.width, height = shaded.height;
    const struct frame_area area = {width, height, {0, 0, width, height}, 1};
    b->gl->BindVertexArray(b->array);
    target_resume(&b->sum, b->gl);
    b->gl->Enable(GL_BLEND);
    b->gl->BlendFunc(GL_ONE, GL_ONE);
    draw_picture(&b->picture, b->gl, &area, &shaded);
    b->gl->Disable(GL_BLEND);
}

static relume_status light_points(struct between *b, const struct objects_drawer *t,
                                  const struct between_view *v, const struct target *panorama)
{
    const struct points_view view = points_view(b, t, v);
    const struct points_lit lit = {.panorama = panorama,
                                   .mean = &b->even,
                                   .let_without = &b->leaf_lamps.target[0],
                                   .let_with = &b->leaf_lamps.target[1]};
    return v->way == BETWEEN_ISM ? ism_light(&b->ism, &b->point_light, &view, &lit)
                                 : micro_light(&b->micro, &b->point_light, &view, &lit);
}

// What objects have gathered, or else the scene.
static void gather_at(struct between *b, const struct objects_drawer *t,
                      const struct between_view *v, const struct target *panorama,
                      const struct target *lone, bool at_objects)
{
    if (has_points(v->way))
        gather_from_points(b, t, v, at_objects);
    else
        gather(b, t, v, panorama, lone, at_objects);
    smooth(b, v, at_objects);
}

relume_status between_light(struct between *b, struct objects_drawer *t,
                            const struct between_view *v, const struct relume_light *light,
                            const struct target *panorama, const struct target *lone,
                            const struct target *lit, float exposure)
{
    relume_status status = objects_drawer_light(t, light, 1);
    joined_begin(&b->by_lamps, b->gl);
    if (has_points(v->way))
        joined_begin(&b->leaf_lamps, b->gl);
    for (int i = 0; i < t->lights.samples && !status; i++)
        status = add_lamp(b, t, v, i);
    t->shadows.captured = &b->mesh;
    if (!status)
        status = objects_drawer_shade(t, v->projection, v->width, v->height, -1);
    t->shadows.captured = NULL;
    if (status)
        return status;
    find_mean(b, v, panorama);
    if (has_points(v->way))
        status = light_points(b, t, v, panorama);
    else
        show(b, t, v, lone);
    if (status)
        return status;
    gather_at(b, t, v, panorama, lone, true);
    throw_back(b, t, &b->thrown);
    if (v->bounces > 1 && !has_points(v->way))
        throw_back(b, t, &b->show);
    gather_at(b, t, v, panorama, lone, false);
    add_scene(b, v, lone, lit, exposure);
    add_shaded(b, t);
    return gl_check(b->gl, "light between objects and scene", b->log);
}

void between_end(struct between *b, struct objects_drawer *t)
{
    const struct target shaded = t->shaded;
    t->shaded = b->sum;
    b->sum = shaded;
}
