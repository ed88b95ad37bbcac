// gl_renderer_objects.c - frames with objects in them: the scene under each light alone, kept off
// where an object stands between, then the objects where they stand before it. Twin:
// relume_renderer_set_objects.
#include "app/handles.h"
#include "cli/program/clock.h"
#include "common/vec.h"
#include "draw/gl_renderer.h"
#include "draw/gl_renderer_parts.h"

#include <math.h>
#include <stdlib.h>

relume_status gl_renderer_use_objects(struct gl_renderer *r, relume_objects *objects,
                                      const struct depth_source *places)
{
    r->stage = !places;
    if (places)
        r->place_source = *places;
    r->place = calloc((size_t)r->views, sizeof *r->place);
    return r->place ? objects_drawer_create(&r->drawer, r->gl, objects, r->log) : RELUME_ENOMEM;
}

void gl_renderer_objects_destroy(struct gl_renderer *r)
{
    for (int i = 0; r->place && i < r->views; i++)
        target_destroy(&r->place[i], r->gl);
    free(r->place);
    target_destroy(&r->scene, r->gl);
    target_destroy(&r->lit, r->gl);
    objects_drawer_destroy(&r->drawer);
}

relume_status gl_renderer_replace_objects(struct gl_renderer *r, relume_objects *objects)
{
    gl_renderer_objects_destroy(r);
    r->place = NULL;
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

static struct relume_window slab_view_window(const struct gl_renderer *r, int view)
{
    const struct relume_geometry *g =
        r->around ? relume_slab_set_geometry(r->around, r->slab_of ? r->slab_of[view] : 0)
                  : &r->geometry;
    const struct relume_vec3 camera = {r->uv[view][0], r->uv[view][1], g->uv_z};
    return relume_slab_window(g, relume_pose_world(&g->pose, camera));
}

// The window of the frame; false for frames that are not flat: unfolded panoramas, little planets.
static bool find_window(struct relume_window *w, const struct gl_renderer *r,
                        const struct frame_request *q)
{
    const struct relume_camera *camera = &q->camera;
    if (camera->framing == RELUME_FRAME_LOOK) {
        *w = look_window(q);
        return !camera->look.stereographic;
    }
    if (camera->framing == RELUME_FRAME_EYE && r->around) {
        *w = q->window;
        return q->has_window;
    }
    if (camera->framing == RELUME_FRAME_EYE)
        *w = relume_slab_window(&r->geometry, camera->eye);
    else if (r->geometry.projection == RELUME_SLAB)
        *w = slab_view_window(r, camera->view);
    else
        *w = planar_window(&r->geometry);
    return r->geometry.projection <= RELUME_SLAB;
}

bool gl_renderer_projection(struct frame_projection *out, const struct gl_renderer *r,
                            const struct frame_request *q, const struct frame_area *area)
{
    const struct relume_objects_info *info = relume_objects_info(r->drawer.objects);
    const struct relume_geometry *g = &r->geometry;
    struct relume_window window;
    if (g->projection == RELUME_PLANAR && !g->perspective) {
        frame_projection_of_plane(out, g->window_min, g->window_max, area->picture, area->width,
                                  area->height, info->min, info->max);
        return true;
    }
    return find_window(&window, r, q) &&
           frame_projection_of_window(out, &window, area->picture, area->width, area->height,
                                      info->min, info->max);
}

// ---------------------------------------------------------------- the scene

static void swap(struct target *a, struct target *b)
{
    const struct target was = *a;
    *a = *b;
    *b = was;
}

// Where the views that the frame needs see the scene, as if that were their light.
static relume_status use_places(struct gl_renderer *r)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < r->views && !status; i++) {
        struct relume_image places;
        r->relit[i] = NULL;
        if (!r->needed[i])
            continue;
        r->relit[i] = &r->place[i];
        if (r->place[i].texture)
            continue;
        status = r->place_source.depth(&places, r->place_source.user, i);
        if (!status)
            status = target_create(&r->place[i], r->gl, places.width, places.height, r->log);
        if (!status)
            target_write(&r->place[i], r->gl, &places);
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
    swap(&r->frame, &r->scene);
    return status;
}

// r->frame becomes the sum of all lights where they reach.
static relume_status light_scene(struct gl_renderer *r, const struct frame_request *q,
                                 const struct frame_area *area, const struct relume_light *lights,
                                 int count)
{
    relume_status status = RELUME_OK;
    target_begin(&r->lit, r->gl);
    for (int i = 0; i < count && !status; i++) {
        status = gl_renderer_relight_views(r, q, &lights[i], 1);
        if (!status)
            status = gl_renderer_frame(r, q, area);
        if (!status)
            status = objects_drawer_light(&r->drawer, &lights[i], 1);
        target_resume(&r->lit, r->gl);
        for (int k = 0; k < r->drawer.light_samples && !status; k++)
            objects_drawer_cast(&r->drawer, area, k, r->scene.texture, &r->frame);
    }
    swap(&r->frame, &r->lit);
    return status;
}

// The panorama that mirrors show, under all lights.
static relume_status find_surround(struct gl_renderer *r, const struct frame_request *q,
                                   const struct relume_light *lights, int count)
{
    r->drawer.panorama = (struct mirror_panorama){.geometry = NULL};
    if (r->geometry.projection < RELUME_CYLINDRICAL || !handles_mirror(r->drawer.objects))
        return RELUME_OK;
    const relume_status status = gl_renderer_relight_views(r, q, lights, count);
    if (!status && r->relit[0] && r->place[0].texture)
        r->drawer.panorama = (struct mirror_panorama){&r->geometry, r->relit[0], &r->place[0]};
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
    relume_status status = gl_renderer_prepare(&r->scene, r, area->width, area->height);
    if (!status)
        status = gl_renderer_prepare(&r->lit, r, area->width, area->height);
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
        objects_drawer_shade(&r->drawer, projection, q->width, q->height, only);
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
    objects_drawer_over(&r->drawer, area, scene, false);
    gl->Scissor(middle - 1, 0, 2, area->height);
    gl->ClearColor(0.5f, 0.5f, 0.5f, 1.0f);
    gl->Clear(GL_COLOR_BUFFER_BIT);
    gl->Disable(GL_SCISSOR_TEST);
}

static relume_status draw_objects(struct gl_renderer *r, const struct frame_request *q,
                                  const struct frame_area *area,
                                  const struct frame_projection *projection)
{
    const GLuint scene = r->stage ? 0 : r->scene.texture;
    const bool both = q->split != APP_SPLIT_NONE;
    relume_status status = RELUME_OK;
    if (both)
        status = shade(r, q, projection, q->other, &r->objects_drawer_ms[1]);
    objects_drawer_swap(&r->drawer);
    if (!status)
        status = shade(r, q, projection, -1, &r->objects_drawer_ms[0]);
    if (status)
        return status;
    r->gl->BindVertexArray(r->vertices);
    target_resume(&r->frame, r->gl);
    objects_drawer_over(&r->drawer, area, scene, q->split == APP_SPLIT_DIFFERENCE);
    if (q->split == APP_SPLIT_SIDES) {
        objects_drawer_swap(&r->drawer);
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
    relume_status status = seen ? objects_drawer_see(&r->drawer, &projection) : RELUME_OK;
    if (!status)
        status = draw_scene(r, q, area, lights, count, seen);
    if (status || !seen || q->pass != RELUME_PASS_COLOUR)
        return status;
    status = objects_drawer_light(&r->drawer, lights, count);
    return status ? status : draw_objects(r, q, area, &projection);
}
