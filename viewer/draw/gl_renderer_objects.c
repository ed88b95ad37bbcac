// gl_renderer_objects.c - frames with objects in them: the scene under each light alone, kept off
// where an object stands between, then the objects where they stand before it. Twin:
// relume_renderer_set_objects.
#include "app/handles.h"
#include "cli/program/clock.h"
#include "common/vec.h"
#include "draw/gl_renderer.h"
#include "draw/gl_renderer_parts.h"
#include "relight/view/slab_set.h"

#include <math.h>
#include <stdlib.h>

relume_status gl_renderer_use_objects(struct gl_renderer *r, relume_objects *objects,
                                      const struct depth_source *places)
{
    r->stage = !places;
    if (places)
        r->objects.position_source = *places;
    r->objects.position = calloc((size_t)r->views.count, sizeof *r->objects.position);
    return r->objects.position ? objects_drawer_create(&r->objects.drawer, r->gl, objects, r->log)
                               : RELUME_ENOMEM;
}

void gl_renderer_objects_destroy(struct gl_renderer *r)
{
    for (int i = 0; r->objects.position && i < r->views.count; i++)
        target_destroy(&r->objects.position[i], r->gl);
    free(r->objects.position);
    target_destroy(&r->objects.scene, r->gl);
    target_destroy(&r->objects.lit, r->gl);
    objects_drawer_destroy(&r->objects.drawer);
}

relume_status gl_renderer_replace_objects(struct gl_renderer *r, relume_objects *objects)
{
    gl_renderer_objects_destroy(r);
    r->objects.position = NULL;
    return gl_renderer_use_objects(r, objects, NULL);
}

// ---------------------------------------------------------------- where the eye is

static struct relume_window planar_window(const struct relume_geometry *g)
{
    return (struct relume_window){
        .eye = {0, 0, g->camera_z},
        .corner = {g->window_min[0], g->window_max[1], 0},
        .right = {g->window_max[0] - g->window_min[0], 0, 0},
        .down = {0, g->window_min[1] - g->window_max[1], 0},
    };
}

// A window at distance 1 along the middle of a perspective look.
static struct relume_window look_window(const struct frame_request *q)
{
    const struct relume_pan_tilt look = q->camera.look;
    const int w = q->width, h = q->height;
    const struct relume_vec3 ahead = relume_pan_tilt_ray(look, w, h, 0.5 * w, 0.5 * h);
    struct relume_vec3 corner[3];
    for (int i = 0; i < 3; i++) {
        corner[i] = relume_pan_tilt_ray(look, w, h, i == 1 ? w : 0, i == 2 ? h : 0);
        corner[i] = vec3_scale(corner[i], 1.0 / vec3_dot(corner[i], ahead));
    }
    const struct relume_vec3 eye = q->file->geometry.center;
    return (struct relume_window){
        .eye = eye,
        .corner = {eye.x + corner[0].x, eye.y + corner[0].y, eye.z + corner[0].z},
        .right = vec3_sub(corner[1], corner[0]),
        .down = vec3_sub(corner[2], corner[0]),
    };
}

static struct relume_window slab_view_window(const struct file_views *v, int view)
{
    const struct relume_geometry *g =
        v->around ? relume_slab_set_geometry(v->around, v->slab_of ? v->slab_of[view] : 0)
                  : &v->geometry;
    const struct relume_vec3 camera = {v->uv[view][0], v->uv[view][1], g->uv_z};
    return relume_slab_window(g, relume_pose_world(&g->pose, camera));
}

// The window of the frame; false for frames that are not flat: unfolded panoramas, little planets.
static bool find_window(struct relume_window *w, const struct file_views *v,
                        const struct frame_request *q)
{
    const struct relume_camera *camera = &q->camera;
    if (camera->framing == RELUME_FRAME_LOOK) {
        *w = look_window(q);
        return !camera->look.stereographic;
    }
    if (camera->framing == RELUME_FRAME_EYE && v->around) {
        *w = q->window;
        return q->has_window;
    }
    if (camera->framing == RELUME_FRAME_EYE)
        *w = relume_slab_window(&v->geometry, camera->eye);
    else if (v->geometry.projection == RELUME_SLAB)
        *w = slab_view_window(v, camera->view);
    else
        *w = planar_window(&v->geometry);
    return v->geometry.projection <= RELUME_SLAB;
}

bool gl_renderer_projection(struct frame_projection *out, const struct gl_renderer *r,
                            const struct frame_request *q, const struct frame_area *area)
{
    const struct relume_objects_info *info = relume_objects_info(r->objects.drawer.objects);
    const struct relume_geometry *g = &r->views.geometry;
    struct relume_window window;
    if (g->projection == RELUME_PLANAR && !g->perspective) {
        frame_projection_of_plane(out, g->window_min, g->window_max, area->picture, area->width,
                                  area->height, info->min, info->max);
        return true;
    }
    return find_window(&window, &r->views, q) &&
           frame_projection_of_window(out, &window, area->picture, area->width, area->height,
                                      info->min, info->max);
}

// ---------------------------------------------------------------- the scene

// Where the views that the frame needs see the scene, as if that were their light.
static relume_status use_places(struct gl_renderer *r)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < r->views.count && !status; i++) {
        struct relume_image places;
        r->views.relit[i] = NULL;
        if (!r->views.needed[i])
            continue;
        r->views.relit[i] = &r->objects.position[i];
        if (r->objects.position[i].texture)
            continue;
        status = r->objects.position_source.depth(&places, r->objects.position_source.user, i);
        if (!status)
            status =
                target_create(&r->objects.position[i], r->gl, places.width, places.height, r->log);
        if (!status)
            target_write(&r->objects.position[i], r->gl, &places);
        relume_image_destroy(&places);
    }
    return status;
}

relume_status gl_renderer_find_scene(struct gl_renderer *r, const struct frame_request *q,
                                     struct frame_area area)
{
    relume_status status = use_places(r);
    area.exposure = 1.0f;
    if (!status)
        status = gl_renderer_frame(r, q, &area);
    target_swap(&r->frame, &r->objects.scene);
    return status;
}

// r->frame becomes the sum of all lights where they reach.
static relume_status light_scene(struct gl_renderer *r, const struct frame_request *q,
                                 const struct frame_area *area, const struct relume_light *lights,
                                 int count)
{
    relume_status status = RELUME_OK;
    target_begin(&r->objects.lit, r->gl);
    for (int i = 0; i < count && !status; i++) {
        status = gl_renderer_relight_views(r, q, &lights[i], 1);
        if (!status)
            status = gl_renderer_frame(r, q, area);
        if (!status)
            status = objects_drawer_light(&r->objects.drawer, &lights[i], 1);
        target_resume(&r->objects.lit, r->gl);
        for (int k = 0; k < r->objects.drawer.lights.samples && !status; k++)
            objects_drawer_cast(&r->objects.drawer, area, k, r->objects.scene.texture, &r->frame);
    }
    target_swap(&r->frame, &r->objects.lit);
    return status;
}

// The panorama that mirrors show, under all lights.
static relume_status find_surround(struct gl_renderer *r, const struct frame_request *q,
                                   const struct relume_light *lights, int count)
{
    r->objects.drawer.panorama = (struct mirror_panorama){.geometry = NULL};
    if (r->views.geometry.projection < RELUME_CYLINDRICAL ||
        !handles_mirror(r->objects.drawer.objects))
        return RELUME_OK;
    const relume_status status = gl_renderer_relight_views(r, q, lights, count);
    if (!status && r->views.relit[0] && r->objects.position[0].texture)
        r->objects.drawer.panorama = (struct mirror_panorama){&r->views.geometry, r->views.relit[0],
                                                              &r->objects.position[0]};
    return status;
}

static relume_status draw_scene(struct gl_renderer *r, const struct frame_request *q,
                                const struct frame_area *area, const struct relume_light *lights,
                                int count, bool seen)
{
    if (r->stage) {
        target_begin(&r->frame, r->gl);
        return RELUME_OK;
    }
    relume_status status = gl_renderer_need(&r->objects.scene, r, area);
    if (!status)
        status = gl_renderer_need(&r->objects.lit, r, area);
    if (!seen || q->pass != RELUME_PASS_COLOUR) {
        if (!status)
            status = gl_renderer_relight_views(r, q, lights, count);
        return status ? status : gl_renderer_frame(r, q, area);
    }
    if (!status)
        status = gl_renderer_find_scene(r, q, *area);
    if (!status)
        status = light_scene(r, q, area, lights, count);
    return status ? status : find_surround(r, q, lights, count);
}

// ---------------------------------------------------------------- the objects

// Objects in their materials, or all in one; `ms` is what it took where the panel shows it.
static relume_status shade(struct gl_renderer *r, const struct frame_request *q,
                           const struct frame_projection *projection, int only, double *ms)
{
    if (q->timed)
        r->gl->Finish();
    const double start = 1e3 * now_s();
    const relume_status status =
        objects_drawer_shade(&r->objects.drawer, projection, q->width, q->height, only);
    if (q->timed)
        r->gl->Finish();
    *ms = 1e3 * now_s() - start;
    return status;
}

// The right half in the other material, and a line between.
static void draw_split(const struct gl_renderer *r, const struct frame_area *area, GLuint scene)
{
    const struct gl *gl = r->gl;
    const int middle = area->width / 2;
    gl->Enable(GL_SCISSOR_TEST);
    gl->Scissor(middle, 0, area->width - middle, area->height);
    objects_drawer_over(&r->objects.drawer, area, scene, false);
    gl->Scissor(middle - 1, 0, 2, area->height);
    gl->ClearColor(0.5f, 0.5f, 0.5f, 1.0f);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    gl->Disable(GL_SCISSOR_TEST);
}

static relume_status draw_objects(struct gl_renderer *r, const struct frame_request *q,
                                  const struct frame_area *area,
                                  const struct frame_projection *projection)
{
    const GLuint scene = r->stage ? 0 : r->objects.scene.texture;
    const bool both = q->split != APP_SPLIT_NONE;
    relume_status status = RELUME_OK;
    if (both)
        status = shade(r, q, projection, q->other, &r->objects.ms[1]);
    objects_drawer_swap(&r->objects.drawer);
    if (!status)
        status = shade(r, q, projection, -1, &r->objects.ms[0]);
    if (status)
        return status;
    r->gl->BindVertexArray(r->vertices);
    target_resume(&r->frame, r->gl);
    objects_drawer_over(&r->objects.drawer, area, scene, q->split == APP_SPLIT_DIFFERENCE);
    if (q->split == APP_SPLIT_SIDES) {
        objects_drawer_swap(&r->objects.drawer);
        draw_split(r, area, scene);
    }
    return RELUME_OK;
}

relume_status gl_renderer_draw_objects(struct gl_renderer *r, const struct frame_request *q,
                                       const struct frame_area *area,
                                       const struct relume_light *lights, int count)
{
    struct frame_projection projection;
    const bool seen = gl_renderer_projection(&projection, r, q, area);
    r->gl->BindVertexArray(r->vertices);
    relume_status status = seen ? objects_drawer_see(&r->objects.drawer, &projection) : RELUME_OK;
    if (!status)
        status = draw_scene(r, q, area, lights, count, seen);
    if (status || !seen || q->pass != RELUME_PASS_COLOUR)
        return status;
    status = objects_drawer_light(&r->objects.drawer, lights, count);
    return status ? status : draw_objects(r, q, area, &projection);
}
