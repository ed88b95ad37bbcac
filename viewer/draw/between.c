// between.c - light between a captured panorama and the objects in it, by draws over the frame.
// Twins: world/object/exchange.c, world/transport/screen.c, world/transport/smooth.c
#include "draw/between.h"

#include "common/vec.h"
#include "draw/between_uniforms.h"
#include "draw/objects_drawer_parts.h"

// Of the ball about the objects, the ball within which what is captured throws shadows on the
// scene.
static const double CAPTURED_RADII = 3.0;
enum { CAPTURED_SIDE = 2048, CAPTURED_SIDE_SOFTWARE = 512 };

// ---------------------------------------------------------------- making

void between_destroy(struct between *b)
{
    if (!b->gl)
        return;
    between_programs_destroy(&b->programs, b->gl);
    between_frame_destroy(&b->frame, b->gl);
    between_points_destroy(&b->points, b->gl);
    between_white_destroy(&b->white, b->gl);
    captured_mesh_destroy(&b->mesh);
    shadow_map_destroy(&b->captured);
    light_uniforms_forget(&b->uniforms);
    b->gl->DeleteVertexArrays(1, &b->array);
    *b = (struct between){.gl = NULL};
}

relume_status between_create(struct between *b, const struct gl *gl,
                             const struct relume_geometry *geometry, const struct target *places,
                             const struct relume_log *log)
{
    const int side = gl->software ? CAPTURED_SIDE_SOFTWARE : CAPTURED_SIDE;
    *b = (struct between){.gl = gl, .log = log, .uniforms = {.gl = gl, .log = log}};
    gl->GenVertexArrays(1, &b->array);
    relume_status status = between_programs_create(&b->programs, gl, geometry, log);
    if (!status)
        status = captured_mesh_create(&b->mesh, gl, geometry, places, log);
    if (!status)
        status = shadow_map_create(&b->captured, gl, side, log);
    if (!status)
        status = between_white_create(&b->white);
    if (!status)
        status = between_frame_create(&b->frame, gl, log);
    if (status)
        between_destroy(b);
    return status;
}

// ---------------------------------------------------------------- draws

// Texture `unit` of the program in use.
static void use_target(const struct between *b, GLint at, int unit, const struct target *target)
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
    target_resume(&b->frame.behind, gl);
    gl->ClearColor(0, 0, 0, 0);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl->UseProgram(b->programs.back.id);
    gl->UniformMatrix4fv(b->programs.back.at[BACK_CLIP], 1, GL_FALSE, v->projection->clip);
    use_target(b, b->programs.back.at[BACK_FRONT], 0, &t->surface.position);
    gl->Uniform1i(b->programs.back.at[BACK_GRID], t->surface.grid);
    use_eye(b, b->programs.back.at[BACK_EYE], v);
    gl->BindVertexArray(t->mesh.array);
    gl->Enable(GL_DEPTH_TEST);
    object_mesh_draw(&t->mesh, 0, object_mesh_drawn(&t->mesh, t->objects)->triangle_count);
    gl->Disable(GL_DEPTH_TEST);
}

static void find_nearest(const struct between *b, const struct objects_drawer *t,
                         const struct between_view *v)
{
    const GLint *at = b->programs.front.at;
    joined_begin(&b->frame.nearest, b->gl);
    b->gl->UseProgram(b->programs.front.id);
    use_target(b, at[F_SCENE], 0, v->scene);
    use_target(b, at[F_OBJECTS], 1, &t->surface.position);
    use_target(b, at[F_NORMALS], 2, &t->surface.normal);
    use_target(b, at[F_BACK], 3, &b->frame.behind);
    b->gl->Uniform1i(at[F_GRID], t->surface.grid);
    use_eye(b, at[F_EYE], v);
    draw_onto(b, &b->programs.front, &b->frame.show);
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

relume_status between_need(struct between *b, const struct objects_drawer *t,
                           const struct relume_geometry *geometry, const struct target *places,
                           enum between_way way, int samples)
{
    return between_has_points(way)
               ? between_points_need(&b->points, b->gl, geometry, places, t->objects,
                                     fingerprint(t), way, samples, b->log)
               : RELUME_OK;
}

relume_status between_begin(struct between *b, struct objects_drawer *t,
                            const struct between_view *v)
{
    const struct relume_light none = {.rgb = {0, 0, 0}};
    relume_status status = objects_drawer_light(t, &none, 0);
    if (!status)
        status = objects_drawer_shade(t, v->projection, v->width, v->height, -1);
    if (!status)
        status =
            between_frame_need(&b->frame, b->gl, v->width, v->height, &t->surface.position, b->log);
    if (!status)
        status = between_white_need(&b->white, t, v->projection, fingerprint(t));
    if (!status)
        status = between_need(b, t, v->geometry, v->panorama_places, v->way, v->samples);
    if (status)
        return status;
    find_backs(b, t, v);
    find_nearest(b, t, v);
    target_begin(&b->frame.thrown, b->gl);
    target_begin(&b->frame.sum, b->gl);
    b->frame.lights = 0;
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
    const GLint *at = b->programs.lamps.at;
    const struct relume_light light = object_lights_of(&t->lights.sample[number]);
    joined_resume(onto, gl);
    gl->UseProgram(b->programs.lamps.id);
    use_target(b, at[DRAW_OWN], 0, place);
    use_target(b, at[LAMPS_FACING], 1, facing);
    gl_set_vec3(gl, at[LAMPS_CENTRE], v->geometry->center);
    gl->Uniform1i(at[LAMPS_PICTURE], 2);
    const relume_status status = light_uniforms_set(&b->uniforms, at + LAMPS_LIGHT, 2, &light);
    if (t->lights.sample[number].is_patch)
        gl_set_vec3(gl, at[LAMPS_LIGHT + LIGHT_AXIS], t->lights.sample[number].patch.normal);
    shadow_map_use(&t->shadows.map, gl, at + LAMPS_SHADOW, 3);
    shadow_map_use(&b->captured, gl, at + LAMPS_CAPTURED, 4);
    draw_added(b, &b->programs.lamps, &onto->target[0]);
    return status;
}

static relume_status add_lamp(struct between *b, struct objects_drawer *t,
                              const struct between_view *v, int number)
{
    objects_drawer_draw_shadow(t, number);
    shadow_map_fill(&b->captured, &t->lights.sample[number], t->shadows.middle,
                    CAPTURED_RADII * t->shadows.radius, draw_captured, &b->mesh);
    const relume_status status =
        add_lamp_at(b, t, v, number, v->scene, &b->frame.nearest.target[0], &b->frame.by_lamps);
    if (status || !between_has_points(v->way))
        return status;
    return add_lamp_at(b, t, v, number, &b->points.cards.leaf_place, &b->points.cards.leaf_facing,
                       &b->points.leaf_lamps);
}

static void use_panorama(const struct between *b, const GLint *at, const struct between_view *v,
                         const struct target *panorama)
{
    use_target(b, at[VIEW], 0, panorama);
    b->gl->Uniform2f(at[ELEVATION], (float)v->geometry->v_min, (float)v->geometry->v_max);
    b->gl->Uniform1f(at[DISC], (float)v->geometry->disc);
}

static void find_mean(const struct between *b, const struct between_view *v,
                      const struct target *panorama)
{
    target_begin(&b->frame.even, b->gl);
    b->gl->UseProgram(b->programs.mean.id);
    use_panorama(b, b->programs.mean.at, v, panorama);
    draw_onto(b, &b->programs.mean, &b->frame.even);
}

static void draw_shown(const struct between *b, const struct objects_drawer *t,
                       const struct between_view *v, const struct target *lone)
{
    const GLint *at = b->programs.shown.at;
    target_begin(&b->frame.show, b->gl);
    b->gl->UseProgram(b->programs.shown.id);
    use_target(b, at[SHOWN_FRONT], 0, &b->frame.nearest.target[1]);
    use_target(b, at[SHOWN_OBJECTS], 1, &t->surface.position);
    use_target(b, at[SHADED], 2, &t->shaded);
    use_target(b, at[LONE], 3, lone);
    use_target(b, at[LET_WITHOUT], 4, &b->frame.by_lamps.target[0]);
    use_target(b, at[LET_WITH], 5, &b->frame.by_lamps.target[1]);
    use_target(b, at[MEAN], 6, &b->frame.even);
    b->gl->Uniform1i(at[SHOWN_GRID], t->surface.grid);
    use_target(b, at[SHOWN_EMITTED], 7, &t->surface.emitted);
    b->gl->Uniform1f(at[SHOWN_SENDS], t->skins.sends ? v->sends : 0.0f);
    draw_onto(b, &b->programs.shown, &b->frame.show);
}

static void gather_from_frame(const struct between *b, const struct objects_drawer *t,
                              const struct between_view *v, const struct target *panorama,
                              const struct target *lone, bool at_objects)
{
    const struct gl *gl = b->gl;
    const GLint *at = b->programs.gather.at;
    joined_begin(&b->frame.gathered, gl);
    gl->UseProgram(b->programs.gather.id);
    use_panorama(b, at, v, panorama);
    use_target(b, at[G_PLACES], 1, v->panorama_places);
    gl_set_vec3(gl, at[G_CENTRE], v->geometry->center);
    use_target(b, at[G_SCENE], 2, v->scene);
    use_target(b, at[G_SCENE_FACING], 3, &b->frame.nearest.target[0]);
    use_target(b, at[G_FRONT], 4, &b->frame.nearest.target[1]);
    use_target(b, at[G_FACING], 5, &b->frame.nearest.target[2]);
    use_target(b, at[G_SHOWN], 6, &b->frame.show);
    use_target(b, at[G_LONE], 7, lone);
    use_target(b, at[G_MEAN], 8, &b->frame.even);
    use_target(b, at[G_ALL_WITHOUT], 9, &b->frame.by_lamps.target[2]);
    use_target(b, at[G_ALL_WITH], 10, &b->frame.by_lamps.target[3]);
    gl_set_vec3(gl, at[G_MIDDLE], t->shadows.middle);
    gl->Uniform1i(at[G_AT_OBJECTS], at_objects);
    gl->Uniform1i(at[G_DIRECTIONAL], v->way == BETWEEN_DIRECTIONAL);
    gl->Uniform1i(at[G_BOUNCES], v->bounces > 0);
    gl->Uniform1i(at[G_SAMPLES], v->samples);
    gl->Uniform1i(at[G_PATTERN], v->pattern);
    gl->Uniform1f(at[G_RADIUS], (float)t->shadows.radius);
    gl->UniformMatrix4fv(at[G_CLIP], 1, GL_FALSE, v->projection->clip);
    use_eye(b, at[G_EYE], v);
    draw_onto(b, &b->programs.gather, &b->frame.show);
}

static struct points_view points_view(const struct between *b, const struct objects_drawer *t,
                                      const struct between_view *v)
{
    const float *eye = v->projection->eye;
    return (struct points_view){.points = &b->points.cards,
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
    const struct points_sites sites = {.place = at_objects ? &b->frame.nearest.target[1] : v->scene,
                                       .facing = &b->frame.nearest.target[at_objects ? 2 : 0],
                                       .kind = at_objects ? 2.0f : 1.0f,
                                       .of_scene = !at_objects,
                                       .without = &b->frame.gathered.target[0],
                                       .with_objects = &b->frame.gathered.target[1]};
    joined_begin(&b->frame.gathered, b->gl);
    between_points_gather(&b->points, &view, v->way, &sites);
}

static void smooth_gathered(const struct between *b, const struct between_view *v, bool at_objects)
{
    const GLint *at = b->programs.smooth.at;
    const float *eye = v->projection->eye;
    joined_begin(&b->frame.smoothed, b->gl);
    b->gl->UseProgram(b->programs.smooth.id);
    use_target(b, at[FIRST], 0, &b->frame.gathered.target[0]);
    use_target(b, at[SECOND], 1, &b->frame.gathered.target[1]);
    use_target(b, at[SMOOTH_PLACE], 2, at_objects ? &b->frame.nearest.target[1] : v->scene);
    use_target(b, at[SMOOTH_FACING], 3, &b->frame.nearest.target[at_objects ? 2 : 0]);
    b->gl->Uniform3f(at[SMOOTH_EYE], eye[0], eye[1], eye[2]);
    b->gl->Uniform1i(at[SIZE_OF], v->pattern);
    draw_onto(b, &b->programs.smooth, &b->frame.show);
}

static void throw_back(const struct between *b, const struct objects_drawer *t,
                       const struct target *onto)
{
    const GLint *at = b->programs.returned.at;
    target_resume(onto, b->gl);
    b->gl->UseProgram(b->programs.returned.id);
    use_target(b, at[RETURNED_FRONT], 0, &b->frame.nearest.target[1]);
    use_target(b, at[GATHERED], 1, &b->frame.smoothed.target[1]);
    use_target(b, at[RETURNED_OBJECTS], 2, &t->surface.position);
    use_target(b, at[WHITE], 3, &b->white.objects);
    b->gl->Uniform1i(at[RETURNED_GRID], t->surface.grid);
    draw_added(b, &b->programs.returned, onto);
}

static void add_scene(const struct between *b, const struct between_view *v,
                      const struct target *lone, const struct target *lit, float exposure)
{
    const GLint *at = b->programs.scene.at;
    target_resume(lit, b->gl);
    b->gl->UseProgram(b->programs.scene.id);
    use_target(b, at[S_SCENE], 0, v->scene);
    use_target(b, at[S_LONE], 1, lone);
    for (int i = 0; i < JOINED_MAX; i++)
        use_target(b, at[S_LET_WITHOUT + i], 2 + i, &b->frame.by_lamps.target[i]);
    use_target(b, at[S_WITHOUT], 6, &b->frame.smoothed.target[0]);
    use_target(b, at[S_WITH], 7, &b->frame.smoothed.target[1]);
    b->gl->Uniform1f(at[S_EXPOSURE], exposure);
    draw_added(b, &b->programs.scene, lit);
}

// The first light is the sum; others are added to it.
static void add_shaded(struct between *b, struct objects_drawer *t)
{
    if (b->frame.lights++ == 0) {
        target_swap(&t->shaded, &b->frame.sum);
        return;
    }
    const int width = t->shaded.width, height = t->shaded.height;
    const struct frame_area area = {width, height, {0, 0, width, height}, 1};
    b->gl->BindVertexArray(b->array);
    target_resume(&b->frame.sum, b->gl);
    b->gl->Enable(GL_BLEND);
    b->gl->BlendFunc(GL_ONE, GL_ONE);
    draw_picture(&b->programs.picture, b->gl, &area, &t->shaded);
    b->gl->Disable(GL_BLEND);
}

// What objects have gathered, or else the scene.
static void gather_at(struct between *b, const struct objects_drawer *t,
                      const struct between_view *v, const struct target *panorama,
                      const struct target *lone, bool at_objects)
{
    if (between_has_points(v->way))
        gather_from_points(b, t, v, at_objects);
    else
        gather_from_frame(b, t, v, panorama, lone, at_objects);
    smooth_gathered(b, v, at_objects);
}

relume_status between_light(struct between *b, struct objects_drawer *t,
                            const struct between_view *v, const struct relume_light *light,
                            const struct target *panorama, const struct target *lone,
                            const struct target *lit, float exposure)
{
    relume_status status = objects_drawer_light(t, light, 1);
    joined_begin(&b->frame.by_lamps, b->gl);
    if (between_has_points(v->way))
        joined_begin(&b->points.leaf_lamps, b->gl);
    for (int i = 0; i < t->lights.samples && !status; i++)
        status = add_lamp(b, t, v, i);
    t->shadows.captured = &b->mesh;
    if (!status)
        status = objects_drawer_shade(t, v->projection, v->width, v->height, -1);
    t->shadows.captured = NULL;
    if (status)
        return status;
    find_mean(b, v, panorama);
    const struct points_view view = points_view(b, t, v);
    if (between_has_points(v->way))
        status = between_points_light(&b->points, &view, v->way, panorama, &b->frame.even);
    else
        draw_shown(b, t, v, lone);
    if (status)
        return status;
    gather_at(b, t, v, panorama, lone, true);
    throw_back(b, t, &b->frame.thrown);
    if (v->bounces > 1 && !between_has_points(v->way))
        throw_back(b, t, &b->frame.show);
    gather_at(b, t, v, panorama, lone, false);
    add_scene(b, v, lone, lit, exposure);
    add_shaded(b, t);
    return gl_check(b->gl, "light between objects and scene", b->log);
}

void between_end(struct between *b, struct objects_drawer *t)
{
    target_swap(&t->shaded, &b->frame.sum);
}
