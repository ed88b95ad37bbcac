// into.c - objects in a relit scene
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "relight/frame/renderer.h"
#include "relight/frame/renderer_views.h"
#include "shape/mesh/places.h"
#include "world/object/coarse.h"
#include "world/object/drawn_objects.h"
#include "world/object/levels.h"
#include "world/object/object.h"
#include "world/object/skin.h"

#include <relume/relight/viewport.h>
#include <string.h>

// ---------------------------------------------------------------- the scene, in their shadow

static relume_status add_light(struct scene_in_shadow *s, relume_renderer *renderer,
                               const struct relume_camera *camera, const struct relume_light *light,
                               int threads)
{
    struct relume_image lone = {0};
    struct relume_object_light *samples;
    relume_status status = relume_objects_lights(&samples, &s->light_samples, s->o, light, 1);
    if (status)
        return status;
    status = relume_renderer_set_lights(renderer, light, 1);
    if (!status)
        status = renderer_bare_frame(&lone, renderer, camera);
    s->light_sample = samples;
    s->lone = &lone;
    if (!status)
        scene_add(s, threads);
    relume_image_destroy(&lone);
    mem_free(samples);
    s->lone = NULL;
    s->light_sample = NULL;
    return status;
}

// ---------------------------------------------------------------- both together

static struct ray ray_of(const void *viewport, double x, double y)
{
    struct ray ray;
    relume_viewport_ray(&ray.origin, &ray.direction, viewport, x, y);
    return ray;
}

struct both {
    const struct layered *layers;
    struct seen *seen;
};

static void layered_value(float rgb[3], const void *context, double x, double y, double step)
{
    const struct both *both = context;
    const struct layered *l = both->layers;
    const size_t pixel = 3 * ((size_t)y * (size_t)l->scene->width + (size_t)x);
    const float *p = l->places->data + pixel;
    struct surface_point point;
    const struct ray ray = ray_of(l->viewport, x, y), right = ray_of(l->viewport, x + step, y),
                     below = ray_of(l->viewport, x, y + step);
    const vec3 to = vec3_sub(vec3_of((double)p[0], (double)p[1], (double)p[2]), ray.origin);
    const double behind = isnan(p[0]) ? INFINITY : vec3_dot(to, ray.direction);
    struct lighting lighting = *l->lighting;
    struct skin_layers layers = {.left = 1.0f};
    lighting.shares = l->shares;
    lighting.pixel = pixel;
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    while (skin_layer(&point, &layers, l->o, &ray, behind)) {
        float value[3];
        objects_spread(&point, l->o, &ray, &right, &below);
        if (!seen_shade(value, both->seen, &point, ray.origin, x, y))
            objects_shade(value, l->o, &point, ray.origin, &lighting);
        for (size_t c = 0; c < 3; c++)
            rgb[c] += layers.part *
                      (value[c] + (l->reflected->data ? l->reflected->data[pixel + c] : 0.0f));
    }
    for (size_t c = 0; c < 3; c++)
        rgb[c] += layers.left * l->scene->data[pixel + c];
}

// Shares of environments hardly differ within a pixel: they are looked for once, through its
// middle, where more rays than one go through it.
struct middles {
    const struct layered *layers;
    int sky;
    struct relume_image places, normals;  // of the objects there; NaN: none
};

static void share_value(float rgb[3], const void *context, double x, double y, double step)
{
    const struct middles *m = context;
    const struct layered *l = m->layers;
    const struct ray ray = ray_of(l->viewport, x, y);
    const vec3 nowhere = vec3_of(NAN, NAN, NAN);
    const size_t pixel = (size_t)y * (size_t)m->places.width + (size_t)x;
    struct surface_point point;
    (void)step;
    rgb[0] = rgb[1] = rgb[2] = NAN;
    const bool is = objects_hit(&point, l->o, ray.origin, ray.direction);
    if (is)
        share_in_pattern(rgb, l->o, &point, l->lighting, m->sky, (int)x, (int)y);
    places_put(&m->places, pixel, is ? point.position : nowhere);
    places_put(&m->normals, pixel, is ? point.normal : nowhere);
}

static relume_status find_shares(struct relume_image *shares, const struct layered *l,
                                 const struct relume_render_params *params)
{
    const int width = l->scene->width, height = l->scene->height;
    struct middles m = {.layers = l};
    struct relume_render_params one = *params;
    relume_status status = relume_image_create(&m.places, width, height, 3);
    if (!status)
        status = relume_image_create(&m.normals, width, height, 3);
    one.samples = 1;
    for (; m.sky < l->lighting->skies && !status; m.sky++) {
        struct relume_image *const share = &shares[m.sky];
        status = relume_image_create(share, width, height, 3);
        if (!status)
            status = objects_trace(share, share_value, &m, &one);
        if (!status)
            status = transport_smooth(&share, 1, &m.places, &m.normals,
                                      relume_viewport_eye(l->viewport), SKY_PATTERN, one.threads);
    }
    relume_image_destroy(&m.places);
    relume_image_destroy(&m.normals);
    return status;
}

static bool lacks_shares(const struct layered *l, const struct relume_render_params *params)
{
    return !l->shares && l->lighting->skies && params->samples > 1 && !params->no_shadows;
}

relume_status objects_layer(struct relume_image *out, const struct layered *given,
                            const struct relume_render_params *params)
{
    struct layered l = *given;
    const int width = l.scene->width, height = l.scene->height, skies = l.lighting->skies;
    struct both both = {.layers = &l};
    struct relume_image *shares = NULL;
    relume_status status = relume_image_create(out, width, height, 3);
    if (!status && lacks_shares(&l, params)) {
        l.shares = shares = mem_zeroed((size_t)skies, sizeof *shares);
        status = shares ? find_shares(shares, given, params) : RELUME_ENOMEM;
    }
    if (!status)
        status =
            seen_create(&both.seen, l.o, l.lighting, width, height, ray_of, l.viewport, params);
    if (!status)
        status = objects_trace(out, layered_value, &both, params);
    seen_destroy(&both.seen);
    for (int i = 0; i < skies && shares; i++)
        relume_image_destroy(&shares[i]);
    mem_free(shares);
    return status;
}

// What a renderer has been given.
struct standing_in {
    const relume_objects *objects;
    relume_objects *shown;  // as the eye of the last frame saw them; NULL: all of them
    struct relume_render_params params;
    bool said;                // that mirrors are black
    bool said_within;         // that the eye is in an object
    bool said_far;            // that the scene is taken to be far away
    struct scenery *scenery;  // the scene as light meets it, of a view; NULL: not needed yet
    int view;                 // ... which one
    struct bodies *bodies;    // of translucent material; NULL: not needed yet
};

static void free_standing_in(void *over)
{
    struct standing_in *in = over;
    if (in) {
        relume_objects_destroy(&in->shown);
        scenery_destroy(&in->scenery);
        bodies_destroy(&in->bodies);
    }
    mem_free(in);
}

// The view that stands for the scene: the one looked at, of a slab the middle one.
static struct relume_camera whole_view(const relume_renderer *renderer,
                                       const struct relume_camera *camera)
{
    const bool views = renderer->info->geometry.projection == RELUME_SLAB;
    const bool from_eye = views && camera->framing != RELUME_FRAME_VIEW;
    return (struct relume_camera){.framing = RELUME_FRAME_VIEW,
                                  .view = from_eye ? renderer->info->views / 2 : camera->view};
}

// A panorama without depth is far away on all sides.
static bool is_far(const relume_renderer *renderer)
{
    return render_exchanges(&((const struct standing_in *)renderer->over)->params) &&
           !renderer->info->has_depth &&
           renderer->info->geometry.projection >= RELUME_CYLINDRICAL &&
           !(renderer->params.assume_depth > 0.0);
}

static relume_status find_places(struct relume_image *places, relume_renderer *renderer,
                                 const struct relume_camera *camera)
{
    struct standing_in *in = renderer->over;
    int frame[2];
    if (!is_far(renderer))
        return relume_renderer_places(places, renderer, camera);
    if (!in->said_far)
        log_line(in->params.log, RELUME_NOTE,
                 "the panorama has no depth: it is taken to be far away, and lights the objects, "
                 "which throw no shadows on it");
    in->said_far = true;
    (void)relume_camera_rect(frame, renderer->info, camera);
    const relume_status status = relume_image_create(places, frame[0], frame[1], 3);
    for (size_t i = 0; i < 3 * (size_t)frame[0] * (size_t)frame[1] && !status; i++)
        places->data[i] = NAN;
    return status;
}

static relume_status need_scenery(struct standing_in *in, relume_renderer *renderer,
                                  const struct relume_camera *view)
{
    struct relume_image places = {0};
    struct relume_viewport viewport;
    if (in->scenery && in->view == view->view)
        return RELUME_OK;
    scenery_destroy(&in->scenery);
    relume_status status = find_places(&places, renderer, view);
    if (!status)
        status = relume_frame_viewport(&viewport, relume_renderer_pack(renderer), view,
                                       places.width, places.height);
    if (!status)
        status = scenery_create(&in->scenery, &renderer->info->geometry,
                                relume_viewport_eye(&viewport), &places, in->params.log);
    in->view = view->view;
    relume_image_destroy(&places);
    return status;
}

// Each light alone, in the shadow of the objects; the renderer has all of them again at the end.
static relume_status light_scene(struct relume_image *scene, const struct relume_image *places,
                                 const relume_objects *o, relume_renderer *renderer,
                                 const struct relume_camera *camera,
                                 const struct relume_light *lights, int n,
                                 const struct relume_render_params *params)
{
    struct scene_in_shadow s = {.o = o, .places = places, .sum = scene, .none = params->no_shadows};
    relume_status status = relume_image_create(scene, places->width, places->height, 3);
    for (int i = 0; i < n && !status; i++)
        status = add_light(&s, renderer, camera, &lights[i], params->threads);
    const relume_status restored = relume_renderer_set_lights(renderer, lights, n);
    return status ? status : restored;
}

// The panorama, relit, and the places that it shows, for mirrors.
static relume_status find_surround(struct surround *s, relume_renderer *renderer,
                                   const struct relume_camera *camera)
{
    const struct relume_camera whole = whole_view(renderer, camera);
    s->geometry = &renderer->info->geometry;
    s->filter = renderer->params.filter;
    const relume_status status = renderer_bare_frame(&s->panorama, renderer, &whole);
    return status ? status : find_places(&s->places, renderer, &whole);
}

static bool mirrors_surroundings(const relume_renderer *renderer, const struct standing_in *in)
{
    return renderer->info->geometry.projection >= RELUME_CYLINDRICAL &&
           objects_have_mirrors(objects_or(in->shown, in->objects));
}

static relume_status light_objects(struct lighting *lighting, relume_renderer *renderer,
                                   const struct relume_camera *camera,
                                   const struct relume_light *lights, int n)
{
    struct standing_in *in = renderer->over;
    const relume_objects *o = objects_or(in->shown, in->objects);
    relume_status status = lighting_create(lighting, o, lights, n, &in->params);
    if (!status && mirrors_surroundings(renderer, in))
        status = find_surround(&lighting->surround, renderer, camera);
    if (!status && !in->said && surround_lacks(&lighting->surround, o)) {
        log_line(in->params.log, RELUME_WARNING, "%s", SURROUND_LACKS);
        in->said = true;
    }
    return status;
}

// One light alone, and what it does between the scene and the objects, in a frame that may have
// fewer pixels than the camera says.
static relume_status exchange_one(struct exchange *e, struct relume_image *scene,
                                  struct relume_image *reflected, struct relume_image *share,
                                  relume_renderer *renderer, const struct relume_camera *camera,
                                  const struct relume_light *light)
{
    struct standing_in *in = renderer->over;
    const struct relume_camera whole = whole_view(renderer, camera);
    struct relume_image lone = {0}, relit = {0};
    relume_status status = relume_renderer_set_lights(renderer, light, 1);
    if (!status)
        status = renderer_bare_frame(&lone, renderer, camera);
    if (!status)
        status = renderer_bare_frame(&relit, renderer, &whole);
    if (!status)
        status = scenery_light(in->scenery, &relit, objects_middle(in->objects));
    if (!status) {
        coarse_means(&lone, scene->width, scene->height);
        status = exchange_light(e, scene, reflected, share, &lone, light);
    }
    relume_image_destroy(&lone);
    relume_image_destroy(&relit);
    return status;
}

// light_scene, with light between the scene and the objects, of which `reflected` is created, too,
// unless it is NULL. As many pixels as places.
static relume_status exchange_all(struct relume_image *scene, struct relume_image *reflected,
                                  struct relume_image *shares, const struct relume_image *places,
                                  const struct relume_viewport *viewport, relume_renderer *renderer,
                                  const struct relume_camera *camera,
                                  const struct relume_light *lights, int n)
{
    struct standing_in *in = renderer->over;
    struct exchange *e = NULL;
    relume_status status = relume_image_create(scene, places->width, places->height, 3);
    if (!status && reflected)
        status = relume_image_create(reflected, places->width, places->height, 3);
    if (!status)
        status = exchange_create(&e, objects_or(in->shown, in->objects), n, in->bodies, in->scenery,
                                 viewport, places, &in->params);
    for (int i = 0; i < n && !status; i++) {
        struct relume_image *share =
            shares && lights[i].kind == RELUME_LIGHT_ENVIRONMENT ? shares++ : NULL;
        if (share)
            status = relume_image_create(share, places->width, places->height, 3);
        if (!status)
            status = exchange_one(e, scene, reflected, share, renderer, camera, &lights[i]);
    }
    exchange_destroy(&e);
    const relume_status restored = relume_renderer_set_lights(renderer, lights, n);
    return status ? status : restored;
}

// What mirrors see of the scene becomes what it is with the objects, found in fewer pixels.
static relume_status exchange_surround(struct surround *s, relume_renderer *renderer,
                                       const struct relume_camera *whole,
                                       const struct relume_light *lights, int n)
{
    enum { ACROSS = 320 };
    const int fewer = (s->panorama.width + ACROSS - 1) / ACROSS;
    struct relume_image places = {0}, with = {0}, without = {0};
    struct relume_viewport viewport;
    relume_status status = coarse_places(&places, &s->places, fewer);
    if (!status)
        status = relume_image_create(&without, s->panorama.width, s->panorama.height, 3);
    if (!status) {
        memcpy(without.data, s->panorama.data,
               3 * (size_t)without.width * (size_t)without.height * sizeof *without.data);
        coarse_means(&without, places.width, places.height);
        status = relume_frame_viewport(&viewport, relume_renderer_pack(renderer), whole,
                                       places.width, places.height);
    }
    if (!status)
        status = exchange_all(&with, NULL, NULL, &places, &viewport, renderer, whole, lights, n);
    if (!status)
        coarse_multiply(&s->panorama, &with, &without,
                        s->geometry->projection == RELUME_CUBE ? EDGE_CLAMPED : EDGE_WRAPPED,
                        ((const struct standing_in *)renderer->over)->params.threads);
    relume_image_destroy(&places);
    relume_image_destroy(&with);
    relume_image_destroy(&without);
    return status;
}

static relume_status draw_over(struct relume_image *out, relume_renderer *renderer,
                               const struct relume_camera *camera)
{
    struct standing_in *in = renderer->over;
    const relume_objects *objects = in->objects;
    const struct relume_render_params *params = &in->params;
    const struct relume_camera whole = whole_view(renderer, camera);
    struct relume_image places = {0}, scene = {0}, reflected = {0};
    struct relume_image *shares = NULL;
    struct lighting lighting = {0};
    struct relume_viewport viewport;
    int n;
    const struct relume_light *own = relume_renderer_lights(&n, renderer);
    struct relume_light *lights = mem_copy(own, (size_t)n, sizeof *lights);
    *out = (struct relume_image){0};
    relume_status status = lights ? find_places(&places, renderer, camera) : RELUME_ENOMEM;
    if (!status)
        status = relume_frame_viewport(&viewport, relume_renderer_pack(renderer), camera,
                                       places.width, places.height);
    if (!status)
        status = relume_objects_shown(&in->shown, objects, relume_viewport_eye(&viewport),
                                      objects_pixel_of_viewport(&viewport), true);
    objects = objects_or(in->shown, objects);
    if (!status) {
        objects_say_around(&in->said_within, objects, relume_viewport_eye(&viewport), params->log);
        status = light_objects(&lighting, renderer, camera, lights, n);
    }
    if (!status && render_exchanges(&in->params)) {
        status = need_scenery(in, renderer, &whole);
        lighting.scenery = (const struct scenery *const *)&in->scenery, lighting.sceneries = 1;
        shares = mem_zeroed((size_t)n, sizeof *shares);
        if (!status && !shares)
            status = RELUME_ENOMEM;
    }
    if (!status)
        status = bodies_need(&in->bodies, objects, params->threads, params->log);
    if (!status)
        status = lighting_enters(&lighting, objects, in->bodies, params->threads, params->log);
    if (!status && render_exchanges(&in->params)) {
        status = exchange_all(&scene, &reflected, shares, &places, &viewport, renderer, camera,
                              lights, n);
        if (!status && mirrors_surroundings(renderer, in))
            status = exchange_surround(&lighting.surround, renderer, &whole, lights, n);
    } else if (!status) {
        status = light_scene(&scene, &places, objects, renderer, camera, lights, n, params);
    }
    const struct layered layers = {objects,    &viewport, &scene,   &places,
                                   &reflected, shares,    &lighting};
    if (!status)
        status = objects_layer(out, &layers, params);
    if (status)
        relume_image_destroy(out);
    relume_image_destroy(&scene);
    relume_image_destroy(&reflected);
    for (int i = 0; i < n && shares; i++)
        relume_image_destroy(&shares[i]);
    mem_free(shares);
    relume_image_destroy(&places);
    lighting_destroy(&lighting);
    mem_free(lights);
    return status;
}

bool render_params_good(const struct relume_render_params *params)
{
    enum { MOST_SAMPLES = 65536, MOST_BOUNCES = 16, MOST_SPACING = 16, MOST_CAMERAS = 16 };
    return params->transport_samples >= 0 && params->transport_samples <= MOST_SAMPLES &&
           params->bounces <= MOST_BOUNCES && params->transport_spacing >= 0 &&
           params->transport_spacing <= MOST_SPACING && params->transport_cameras <= MOST_CAMERAS;
}

bool render_exchanges(const struct relume_render_params *p)
{
    return p->transport && p->transport->gather && !p->no_shadows;
}

relume_status relume_renderer_set_objects(relume_renderer *renderer, const relume_objects *objects,
                                          const struct relume_render_params *params)
{
    const struct standing_in in = {.objects = objects,
                                   .params = PARAMS_WORK(relume_render_params, params)};
    if (!render_params_good(&in.params))
        return RELUME_EINVAL;
    struct standing_in *copy = objects ? mem_copy(&in, 1, sizeof in) : NULL;
    if (objects && !copy)
        return RELUME_ENOMEM;
    free_standing_in(renderer->over);
    renderer->over = copy;
    renderer->free_over = free_standing_in;
    renderer->draw_over = objects ? draw_over : NULL;
    return RELUME_OK;
}
