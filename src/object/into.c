// into.c - objects in a relit scene
#include "base/log.h"
#include "base/memory.h"
#include "base/params.h"
#include "base/thread.h"
#include "frame/renderer.h"
#include "object/object.h"

#include <relume/viewport.h>
#include <string.h>

// ---------------------------------------------------------------- the scene, in their shadow

struct shadows {
    const relume_objects *o;
    const struct relume_image *places, *lone;
    struct relume_image *sum;
    const struct relume_object_light *light_samples;
    int n;
    bool none;
};

static vec3 place_at(const struct relume_image *places, size_t x, size_t y)
{
    const float *p = places->data + 3 * (y * (size_t)places->width + x);
    return vec3_of((double)p[0], (double)p[1], (double)p[2]);
}

// From one pixel to the next: of the steps to both sides the shorter one, which stays on the
// surface.
static vec3 step_across(vec3 before, vec3 at, vec3 after)
{
    const vec3 back = vec3_sub(at, before), on = vec3_sub(after, at);
    const double b = vec3_length(back), o = vec3_length(on);
    const bool is_on = o > 0.0 && !(b > 0.0 && b < o);
    return is_on ? on : b > 0.0 ? back : vec3_of(0, 0, 0);
}

// The next place to one side. In an enlarged picture several pixels in a row show the same one.
static vec3 place_beside(const struct relume_image *places, int x, int y, int dx, int dy)
{
    enum { MOST = 64 };  // so far enlarged
    const vec3 at = place_at(places, (size_t)x, (size_t)y);
    vec3 beside = at;
    for (int i = 0; i < MOST && at.x == beside.x && at.y == beside.y && at.z == beside.z; i++) {
        x += dx;
        y += dy;
        if (x < 0 || y < 0 || x >= places->width || y >= places->height)
            break;
        beside = place_at(places, (size_t)x, (size_t)y);
    }
    return beside;
}

// Which way the scene faces in a pixel, from the places beside it; 0 where they are too far away.
static vec3 scene_normal(const struct relume_image *places, int x, int y)
{
    const vec3 at = place_at(places, (size_t)x, (size_t)y);
    const vec3 across =
        step_across(place_beside(places, x, y, -1, 0), at, place_beside(places, x, y, 1, 0));
    const vec3 down =
        step_across(place_beside(places, x, y, 0, -1), at, place_beside(places, x, y, 0, 1));
    const vec3 normal = vec3_cross(down, across);
    return vec3_length(normal) > 0.0 ? vec3_unit(normal) : vec3_of(0, 0, 0);
}

// What a light sample among several of one light counts for in a pixel: its value times n.l.
static double counts_for(const struct relume_object_light *light_sample, vec3 towards, vec3 normal)
{
    const float *rgb = light_sample->is_patch ? light_sample->patch.rgb : light_sample->light.rgb;
    const bool unknown = vec3_length(normal) == 0.0;
    return (double)(rgb[0] + rgb[1] + rgb[2]) *
           (unknown ? 1.0 : fmax(vec3_dot(normal, towards), 0.0));
}

// The share of a light that reaches a point. One light sample does or does not.
static double share(const struct shadows *s, vec3 point, vec3 normal)
{
    double sent = 0.0, arrived = 0.0;
    for (int i = 0; i < s->n; i++) {
        float unused[3];
        double distance;
        vec3 towards;
        const struct relume_object_light *light_sample = &s->light_samples[i];
        (void)relume_object_light_at(&towards, unused, &distance, light_sample, point);
        const double value = s->n > 1 ? counts_for(light_sample, towards, normal) : 1.0;
        sent += value;
        if (value > 0.0 && objects_reached(s->o, point, vec3_of(0, 0, 0), towards, distance))
            arrived += value;
    }
    return sent > 0.0 ? arrived / sent : 1.0;
}

static void add_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct shadows *s = context;
    const size_t width = (size_t)s->sum->width;
    for (size_t x = 0; x < width; x++) {
        const size_t i = 3 * (row * width + x);
        const float *lone = s->lone->data + i;
        const bool lit = lone[0] != 0.0f || lone[1] != 0.0f || lone[2] != 0.0f;
        const vec3 at = place_at(s->places, x, row);
        const double part = lit && !s->none && !isnan(at.x)
                                ? share(s, at, scene_normal(s->places, (int)x, (int)row))
                                : 1.0;
        for (size_t c = 0; c < 3; c++)
            s->sum->data[i + c] += (float)(part * (double)lone[c]);
    }
}

static relume_status add_light(struct shadows *s, relume_renderer *renderer,
                               const struct relume_camera *camera, const struct relume_light *light,
                               int threads)
{
    struct relume_image lone = {0};
    struct relume_object_light *light_samples;
    relume_status status = relume_objects_lights(&light_samples, &s->n, s->o, light, 1);
    if (status)
        return status;
    status = relume_renderer_set_lights(renderer, light, 1);
    if (!status)
        status = renderer_bare_frame(&lone, renderer, camera);
    s->light_samples = light_samples;
    s->lone = &lone;
    if (!status)
        thread_for(threads, (size_t)lone.height, add_row, s);
    relume_image_destroy(&lone);
    mem_free(light_samples);
    s->lone = NULL;
    s->light_samples = NULL;
    return status;
}

// ---------------------------------------------------------------- both together

struct layered {
    const relume_objects *o;
    const struct relume_viewport *viewport;
    const struct relume_image *scene, *places;
    const struct lighting *lighting;
};

static struct ray ray_of(const struct relume_viewport *viewport, double x, double y)
{
    struct ray ray;
    relume_viewport_ray(&ray.origin, &ray.direction, viewport, x, y);
    return ray;
}

static void layered_value(float rgb[3], const void *context, double x, double y, double step)
{
    const struct layered *l = context;
    const size_t pixel = 3 * ((size_t)y * (size_t)l->scene->width + (size_t)x);
    const float *p = l->places->data + pixel;
    struct surface_point point;
    const struct ray ray = ray_of(l->viewport, x, y), right = ray_of(l->viewport, x + step, y),
                     below = ray_of(l->viewport, x, y + step);
    const vec3 to = vec3_sub(vec3_of((double)p[0], (double)p[1], (double)p[2]), ray.origin);
    memcpy(rgb, l->scene->data + pixel, 3 * sizeof *rgb);
    if (!objects_hit(&point, l->o, ray.origin, ray.direction) ||
        !(isnan(p[0]) || point.distance < vec3_dot(to, ray.direction)))
        return;
    objects_spread(&point, l->o, &ray, &right, &below);
    objects_shade(rgb, l->o, &point, ray.origin, l->lighting);
}

static relume_status layer(struct relume_image *out, const struct layered *l,
                           const struct relume_render_params *params)
{
    relume_status status = relume_image_create(out, l->scene->width, l->scene->height, 3);
    return status ? status : objects_trace(out, layered_value, l, params);
}

// Each light alone, in the shadow of the objects; the renderer has all of them again at the end.
static relume_status light_scene(struct relume_image *scene, const struct relume_image *places,
                                 const relume_objects *o, relume_renderer *renderer,
                                 const struct relume_camera *camera,
                                 const struct relume_light *lights, int n,
                                 const struct relume_render_params *params)
{
    struct shadows s = {.o = o, .places = places, .sum = scene, .none = params->no_shadows};
    relume_status status = relume_image_create(scene, places->width, places->height, 3);
    for (int i = 0; i < n && !status; i++)
        status = add_light(&s, renderer, camera, &lights[i], params->threads);
    const relume_status restored = relume_renderer_set_lights(renderer, lights, n);
    return status ? status : restored;
}

// What a renderer has been given.
struct standing_in {
    const relume_objects *objects;
    struct relume_render_params params;
    bool said;  // that mirrors are black
};

// The panorama, relit, and the places that it shows, for mirrors.
static relume_status find_surround(struct surround *s, relume_renderer *renderer,
                                   const struct relume_camera *camera)
{
    const struct relume_camera whole = {.framing = RELUME_FRAME_VIEW, .view = camera->view};
    s->geometry = &renderer->info->geometry;
    s->filter = renderer->params.filter;
    const relume_status status = renderer_bare_frame(&s->panorama, renderer, &whole);
    return status ? status : relume_renderer_places(&s->places, renderer, &whole);
}

static relume_status light_objects(struct lighting *lighting, relume_renderer *renderer,
                                   const struct relume_camera *camera,
                                   const struct relume_light *lights, int n)
{
    struct standing_in *in = renderer->over;
    const bool around = renderer->info->geometry.projection >= RELUME_CYLINDRICAL;
    relume_status status = lighting_create(lighting, in->objects, lights, n, &in->params);
    if (!status && around && objects_have_mirrors(in->objects))
        status = find_surround(&lighting->surround, renderer, camera);
    if (!status && !in->said && surround_lacks(&lighting->surround, in->objects)) {
        log_line(in->params.log, RELUME_WARNING, "%s", SURROUND_LACKS);
        in->said = true;
    }
    return status;
}

static relume_status draw_over(struct relume_image *out, relume_renderer *renderer,
                               const struct relume_camera *camera)
{
    const struct standing_in *in = renderer->over;
    const relume_objects *objects = in->objects;
    const struct relume_render_params *params = &in->params;
    struct relume_image places = {0}, scene = {0};
    struct lighting lighting = {0};
    struct relume_viewport viewport;
    int n;
    const struct relume_light *own = relume_renderer_lights(&n, renderer);
    struct relume_light *lights = mem_copy(own, (size_t)n, sizeof *lights);
    *out = (struct relume_image){0};
    relume_status status =
        lights ? relume_renderer_places(&places, renderer, camera) : RELUME_ENOMEM;
    if (!status)
        status = relume_frame_viewport(&viewport, relume_renderer_pack(renderer), camera,
                                       places.width, places.height);
    if (!status)
        status = light_objects(&lighting, renderer, camera, lights, n);
    if (!status)
        status = light_scene(&scene, &places, objects, renderer, camera, lights, n, params);
    const struct layered layers = {objects, &viewport, &scene, &places, &lighting};
    if (!status)
        status = layer(out, &layers, params);
    if (status)
        relume_image_destroy(out);
    relume_image_destroy(&scene);
    relume_image_destroy(&places);
    lighting_destroy(&lighting);
    mem_free(lights);
    return status;
}

relume_status relume_renderer_set_objects(relume_renderer *renderer, const relume_objects *objects,
                                          const struct relume_render_params *params)
{
    const struct standing_in in = {objects, PARAMS_WORK(relume_render_params, params), false};
    struct standing_in *copy = objects ? mem_copy(&in, 1, sizeof in) : NULL;
    if (objects && !copy)
        return RELUME_ENOMEM;
    mem_free(renderer->over);
    renderer->over = copy;
    renderer->draw_over = objects ? draw_over : NULL;
    return RELUME_OK;
}
