// exhibit.c - a captured file as one thing of a scene
//
// Slabs make frames for any eye by themselves. All others are a mesh through the places of one
// view, which rays from the eye hit; what is seen there is looked up in the relit view where it
// shows that place.
#include "world/tableau/exhibit.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "relight/frame/renderer.h"
#include "relight/frame/renderer_views.h"
#include "relight/frame/viewport.h"
#include "relight/view/view.h"
#include "shape/mesh/places.h"

#include <relume/exchange.h>
#include <relume/relight/view.h>

#include <string.h>

// ---------------------------------------------------------------- between its world and the
// scene's

static vec3 vector_within(const struct exhibit *c, vec3 v)
{
    const double s = 1.0 / (c->scale * c->scale);
    return vec3_of(s * vec3_dot(v, c->pose.x), s * vec3_dot(v, c->pose.y),
                   s * vec3_dot(v, c->pose.z));
}

static vec3 point_within(const struct exhibit *c, vec3 p)
{
    return vector_within(c, vec3_sub(p, c->pose.origin));
}

// Of places in its own world.
static void into_scene(const struct exhibit *c, const struct relume_image *places)
{
    const size_t pixels = (size_t)places->width * (size_t)places->height;
    for (size_t i = 0; i < pixels; i++)
        places_put(places, i, frame_point(&c->pose, places_at(places, i)));
}

static struct relume_camera camera_within(const struct exhibit *c,
                                          const struct relume_camera *camera)
{
    struct relume_camera own = *camera;
    own.framing = RELUME_FRAME_EYE;
    own.eye = point_within(c, camera->eye);
    own.look_at.at = point_within(c, camera->look_at.at);
    if (!vec3_is_zero(camera->look_at.up))
        own.look_at.up = vec3_unit(vector_within(c, camera->look_at.up));
    return own;
}

// Near lights of value 1 have it a unit of length away.
static struct relume_light light_within(const struct exhibit *c, const struct relume_light *light)
{
    struct relume_light own = *light;
    own.direction = vector_within(c, light->direction);
    own.position = point_within(c, light->position);
    own.u = vector_within(c, light->u);
    own.v = vector_within(c, light->v);
    own.rotate_deg += 180.0 / M_PI * atan2(c->pose.z.x, c->pose.z.z);
    const bool falls =
        relume_light_is_near(light->kind) && light->kind != RELUME_LIGHT_AREA && !light->nofall;
    for (int k = 0; k < 3 && falls; k++)
        own.rgb[k] = (float)((double)light->rgb[k] / (c->scale * c->scale));
    return own;
}

// ---------------------------------------------------------------- opening

static bool is_slab(const struct exhibit *c)
{
    return relume_pack_info(c->pack)->geometry.projection == RELUME_SLAB;
}

static bool is_panorama(const struct exhibit *c)
{
    return relume_pack_info(c->pack)->geometry.projection >= RELUME_CYLINDRICAL;
}

// A panorama without depth is far away on all sides.
relume_status exhibit_whole_places(struct relume_image *places, struct exhibit *c)
{
    const struct relume_pack_info *info = relume_pack_info(c->pack);
    if (info->has_depth || !is_panorama(c))
        return relume_renderer_places(places, c->renderer, &c->whole);
    const relume_status status = relume_image_create(places, info->width, info->height, 3);
    for (size_t i = 0; !status && i < 3 * (size_t)info->width * (size_t)info->height; i++)
        places->data[i] = NAN;
    return status;
}

static relume_status find_surface(struct exhibit *c, const struct relume_log *log)
{
    struct relume_geometry geometry = relume_pack_info(c->pack)->geometry;
    struct relume_image places = {0};
    relume_status status = exhibit_whole_places(&places, c);
    if (!status)
        status =
            relume_frame_viewport(&c->viewport, c->pack, &c->whole, places.width, places.height);
    geometry.center = frame_point(&c->pose, geometry.center);
    if (!status) {
        const vec3 eye = frame_point(&c->pose, relume_viewport_eye(&c->viewport));
        into_scene(c, &places);
        status = scenery_create(&c->scenery, &geometry, eye, &places, log);
    }
    relume_image_destroy(&places);
    return status;
}

relume_status exhibit_open(struct exhibit *out, const char *path, const struct frame *pose,
                           const struct relume_tableau_params *params)
{
    const double UPRIGHT = 1.0 - 1e-9;
    *out = (struct exhibit){.pose = *pose, .scale = vec3_length(pose->x)};
    out->turned_aside = pose->y.y / out->scale < UPRIGHT;
    relume_status status = relume_open(
        &out->pack, path,
        relume_open_params(.log = params->log, .limits = params->limits, .threads = params->threads,
                           .sphere = true, .allow_outside = params->allow_outside,
                           .keep_going = params->keep_going));
    if (status)
        return status;
    const struct relume_pack_info *info = relume_pack_info(out->pack);
    if (is_slab(out) && !info->has_depth)
        return log_fail(params->log, RELUME_EUNFIT,
                        "%s: expected a slab with depth, or nobody knows what stands before what; "
                        "encode one whose capture has depth",
                        path);
    out->whole = (struct relume_camera){.framing = RELUME_FRAME_VIEW,
                                        .view = is_slab(out) ? info->views / 2 : 0};
    status =
        relume_renderer_create(&out->renderer, out->pack,
                               relume_frame_params(.log = params->log, .threads = params->threads,
                                                   .memory = params->memory));
    if (status)
        return status;
    out->renderer->is_part = true;
    return find_surface(out, params->log);
}

void exhibit_destroy(struct exhibit *c)
{
    scenery_destroy(&c->scenery);
    relume_renderer_destroy(&c->renderer);
    relume_pack_destroy(&c->pack);
    relume_image_destroy(&c->relit);
}

struct relume_camera exhibit_camera(const struct exhibit *c)
{
    const struct relume_pack_info *info = relume_pack_info(c->pack);
    struct relume_camera camera = {
        .framing = RELUME_FRAME_EYE, .width = info->width, .height = info->height};
    if (is_panorama(c)) {
        camera.eye = info->geometry.center;
        camera.look_at =
            (struct relume_look_at){true, vec3_add(camera.eye, vec3_of(0, 0, -1)), {0, 1, 0}, 90.0};
        camera.width = 1024, camera.height = 512;
        return camera;
    }
    const struct relume_window w =
        is_slab(c) ? c->viewport.window : relume_planar_window(&info->geometry);
    const vec3 middle = vec3_along(vec3_along(w.corner, w.right, 0.5), w.down, 0.5);
    camera.eye = relume_viewport_eye(&c->viewport);
    const double away = vec3_length(vec3_sub(middle, camera.eye));
    camera.look_at = (struct relume_look_at){
        true, middle, {0, 1, 0}, 360.0 / M_PI * atan(0.5 * vec3_length(w.right) / away)};
    return camera;
}

// ---------------------------------------------------------------- frames

struct pixels {
    const struct exhibit *c;
    const struct relume_window *window;
    const struct relume_image *places;
    struct relume_image *out;
};

static vec3 direction_of(const struct relume_window *w, const struct relume_image *frame, size_t x,
                         size_t y)
{
    const vec3 at = vec3_along(vec3_along(w->corner, w->right, ((double)x + 0.5) / frame->width),
                               w->down, ((double)y + 0.5) / frame->height);
    return vec3_unit(vec3_sub(at, w->eye));
}

static void meet_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct pixels *p = context;
    const size_t width = (size_t)p->out->width;
    for (size_t x = 0; x < width; x++) {
        struct scenery_hit hit;
        const vec3 towards = direction_of(p->window, p->out, x, row);
        const bool is = scenery_meet(&hit, p->c->scenery, p->window->eye, towards);
        places_put(p->out, row * width + x, is ? hit.place : vec3_of(NAN, NAN, NAN));
    }
}

// Of a slab: what its own frame shows, without its background.
static relume_status slab_places(struct relume_image *out, const struct exhibit *c,
                                 const struct relume_camera *camera)
{
    const struct relume_camera own = camera_within(c, camera);
    const relume_status status = relume_renderer_places(out, c->renderer, &own);
    if (status)
        return status;
    into_scene(c, out);
    for (size_t i = 0; i < (size_t)out->width * (size_t)out->height; i++)
        if (!scenery_holds(c->scenery, places_at(out, i)))
            places_put(out, i, vec3_of(NAN, NAN, NAN));
    return RELUME_OK;
}

relume_status exhibit_places(struct relume_image *out, const struct exhibit *c,
                             const struct relume_camera *camera, const struct relume_window *window,
                             int threads)
{
    if (is_slab(c))
        return slab_places(out, c, camera);
    const struct pixels p = {c, window, NULL, out};
    const relume_status status = relume_image_create(out, camera->width, camera->height, 3);
    if (!status)
        thread_for(threads, (size_t)out->height, meet_row, (void *)&p);
    return status;
}

static void far_value(float rgb[3], const struct exhibit *c, vec3 direction)
{
    const struct relume_geometry *g = &relume_pack_info(c->pack)->geometry;
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (is_panorama(c))
        (void)relume_panorama_sample(rgb, g, &c->relit, vector_within(c, direction), NULL);
}

static void value_at(float rgb[3], const struct exhibit *c, vec3 place)
{
    const vec3 own = point_within(c, place);
    const struct relume_geometry *g = &relume_pack_info(c->pack)->geometry;
    double xy[2];
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (is_panorama(c)) {
        (void)relume_panorama_sample(rgb, g, &c->relit, vec3_unit(vec3_sub(own, g->center)), NULL);
        return;
    }
    if (!relume_viewport_project(xy, &c->viewport, own))
        return;
    const struct bilinear b =
        bilinear_at(xy[0] - 0.5, xy[1] - 0.5, c->relit.width, c->relit.height, EDGE_CLAMPED);
    for (int k = 0; k < 4; k++)
        for (size_t i = 0; i < 3; i++)
            rgb[i] += bilinear_sharef(&b, k, c->relit.data[3 * b.at[k] + i]);
}

static void light_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct pixels *p = context;
    const size_t width = (size_t)p->out->width;
    for (size_t x = 0; x < width; x++) {
        const size_t pixel = row * width + x;
        const vec3 place = places_at(p->places, pixel);
        float *rgb = p->out->data + 3 * pixel;
        if (isnan(place.x))
            far_value(rgb, p->c, direction_of(p->window, p->out, x, row));
        else
            value_at(rgb, p->c, place);
    }
}

static relume_status check_turned(const struct exhibit *c, const struct relume_light *light,
                                  const struct relume_log *log)
{
    const bool has_up = light->kind == RELUME_LIGHT_ENVIRONMENT ||
                        light->kind == RELUME_LIGHT_SLIDE || light->kind == RELUME_LIGHT_IES ||
                        light->kind == RELUME_LIGHT_GONIO;
    if (!c->turned_aside || !has_up)
        return RELUME_OK;
    return log_fail(log, RELUME_EUNFIT,
                    "light '%s' cannot fall on capture '%s', which is turned about another axis "
                    "than y; turn it about [0, 1, 0], or take another light",
                    relume_light_kind_name(light->kind), c->name);
}

// Its whole view, which an eye that moves needs again.
static relume_status relight_whole(struct exhibit *c, const struct relume_light *own)
{
    if (c->relit.data && !memcmp(&c->relit_by, own, sizeof *own))
        return RELUME_OK;
    relume_image_destroy(&c->relit);
    memcpy(&c->relit_by, own, sizeof *own);
    return relume_renderer_frame(&c->relit, c->renderer, &c->whole);
}

relume_status exhibit_light(struct relume_image *out, struct exhibit *c,
                            const struct relume_camera *camera, const struct relume_window *window,
                            const struct relume_image *places, const struct relume_light *light,
                            const struct relume_render_params *params)
{
    const struct relume_light own = light_within(c, light);
    relume_status status = check_turned(c, light, params->log);
    if (!status)
        status = relume_renderer_set_lights(c->renderer, &own, 1);
    if (!status && (!is_slab(c) || params->transport))
        status = relight_whole(c, &own);
    if (status)
        return status;
    if (is_slab(c)) {
        const struct relume_camera within = camera_within(c, camera);
        return relume_renderer_frame(out, c->renderer, &within);
    }
    const struct pixels p = {c, window, places, out};
    status = relume_image_create(out, camera->width, camera->height, 3);
    if (!status)
        thread_for(params->threads, (size_t)out->height, light_row, (void *)&p);
    return status;
}
