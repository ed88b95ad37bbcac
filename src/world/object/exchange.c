// exchange.c - light between a captured scene and the objects in it (relume/world/transport.h), at
// the pixels of a frame
//
// A frame has two layers: the scene, and the objects where they are before it. For each light of
// the rig the way of transport gathers what arrives at every pixel of both; what neighbours have
// gathered is smoothed over surfaces. A pixel of the scene becomes
//     shown * (lamps with objects + gathered with) / (lamps + gathered without)
// where the lamps are those that the captured mesh lets through. Where nothing differs the quotient
// is exactly 1.
#include "world/object/exchange.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "core/math/random.h"

#include <string.h>

// ---------------------------------------------------------------- pixels

struct run {
    struct exchange *e;
    do_pixel *pixel;
    size_t first, each, end;
};

static void do_run(void *context, size_t item, int worker)
{
    (void)worker;
    const struct run *r = context;
    const size_t width = (size_t)r->e->scene.places.width, from = r->first + item * r->each;
    for (size_t i = from; i < from + r->each && i < r->end; i++)
        r->pixel(r->e, (int)(i % width), (int)(i / width));
}

relume_status exchange_over_pixels(struct exchange *e, int rays, do_pixel *pixel)
{
    enum { AT_ONCE = 1 << 19, ITEMS = 64 };
    const size_t pixels = (size_t)e->scene.places.width * (size_t)e->scene.places.height;
    const size_t some = (size_t)(AT_ONCE / rays) + 2, each = (some + ITEMS - 1) / ITEMS;
    for (struct run r = {e, pixel, 0, each, 0}; r.first < pixels; r.first = r.end) {
        r.end = r.first + some < pixels ? r.first + some : pixels;
        thread_for(e->params.threads, (r.end - r.first + each - 1) / each, do_run, &r);
        if (!log_progress(e->params.log, "gathering light", (double)r.end / (double)pixels))
            return RELUME_ECANCEL;
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- layers

struct ray exchange_ray(const struct exchange *e, int x, int y, const double at[2])
{
    struct ray ray;
    relume_viewport_ray(&ray.origin, &ray.direction, e->viewport, x + at[0], y + at[1]);
    return ray;
}

bool exchange_objects_at(struct surface_point *point, const struct exchange *e, int x, int y)
{
    static const double within[][2] = {{0.5, 0.5}, {0.2, 0.2}, {0.8, 0.2}, {0.2, 0.8}, {0.8, 0.8}};
    const vec3 scene = places_at(&e->scene.places, exchange_pixel(e, x, y));
    for (size_t i = 0; i < sizeof within / sizeof *within; i++) {
        const struct ray ray = exchange_ray(e, x, y, within[i]);
        if (objects_hit(point, e->o, ray.origin, ray.direction) &&
            !(point->distance >= vec3_length(vec3_sub(scene, ray.origin))))
            return true;
    }
    return false;
}

// The distance at which a ray that meets the objects there leaves them again.
static double back_of(const struct exchange *e, const struct surface_point *front)
{
    const vec3 along = vec3_unit(vec3_sub(front->position, e->eye));
    const vec3 inside = vec3_along(front->position, along, 1e-4 * front->distance);
    struct surface_point back;
    return vec3_length(vec3_sub(inside, e->eye)) +
           (objects_hit(&back, e->o, inside, along) ? back.distance : 0.0);
}

static void find_layers(struct exchange *e, int x, int y)
{
    const size_t pixel = exchange_pixel(e, x, y);
    const vec3 place = places_at(&e->scene.places, pixel), nowhere = vec3_of(NAN, NAN, NAN);
    vec3 normal = scene_normal(&e->scene.places, x, y);
    const vec3 to_eye = vec3_unit(vec3_sub(e->eye, place));
    if (vec3_is_zero(normal))
        normal = to_eye;
    if (vec3_dot(normal, to_eye) < 0.0)
        normal = vec3_scale(normal, -1.0);
    struct surface_point point;
    const bool is = exchange_objects_at(&point, e, x, y);
    places_put(&e->scene.normals, pixel, normal);
    places_put(&e->objects.places, pixel, is ? point.position : nowhere);
    places_put(&e->objects.normals, pixel, is ? point.normal : nowhere);
    e->behind[pixel] = is ? (float)back_of(e, &point) : INFINITY;
    places_put(&e->frame.places, pixel, is ? point.position : place);
    places_put(&e->frame.normals, pixel, is ? point.normal : normal);
}

static relume_status make_layer(struct layer *layer, int width, int height)
{
    const relume_status status = relume_image_create(&layer->places, width, height, 3);
    return status ? status : relume_image_create(&layer->normals, width, height, 3);
}

static void destroy_layer(struct layer *layer)
{
    relume_image_destroy(&layer->places);
    relume_image_destroy(&layer->normals);
}

void exchange_destroy(struct exchange **e)
{
    if (!*e)
        return;
    destroy_layer(&(*e)->scene);
    destroy_layer(&(*e)->objects);
    destroy_layer(&(*e)->frame);
    mem_free((*e)->behind);
    mem_free(*e);
    *e = NULL;
}

static int spacing_of(const struct relume_render_params *params)
{
    const int own = params->transport->spacing;
    return own && params->transport_spacing ? params->transport_spacing : own > 1 ? own : 1;
}

static int cameras_of(const struct relume_render_params *params)
{
    const struct relume_transport *t = params->transport;
    return !t->screen ? 0 : params->transport_cameras ? params->transport_cameras : t->cameras;
}

relume_status exchange_create(struct exchange **out, const relume_objects *o, int lights,
                              const struct bodies *bodies, const struct scenery *scenery,
                              const struct relume_viewport *viewport,
                              const struct relume_image *places,
                              const struct relume_render_params *params)
{
    enum { PIXEL_BYTES = 19 * 3 * sizeof(float) };  // images of three numbers, at once
    const int width = places->width, height = places->height;
    *out = NULL;
    relume_status status =
        limits_memory(NULL, (uint64_t)width * (uint64_t)height * PIXEL_BYTES,
                      "light between objects and a picture of this size", params->log);
    struct exchange *e = status ? NULL : mem_zeroed(1, sizeof *e);
    if (!e)
        return status ? status : RELUME_ENOMEM;
    *e = (struct exchange){.o = o,
                           .bodies = bodies,
                           .scenery = scenery,
                           .viewport = viewport,
                           .transport = params->transport,
                           .params = *params,
                           .sends = 1.0f / (float)lights,
                           .spacing = spacing_of(params),
                           .cameras = cameras_of(params),
                           .eye = relume_viewport_eye(viewport)};
    status = make_layer(&e->scene, width, height);
    if (!status)
        status = make_layer(&e->objects, width, height);
    if (!status)
        status = make_layer(&e->frame, width, height);
    e->behind = mem_array((size_t)width * (size_t)height, sizeof *e->behind);
    if (!status && !e->behind)
        status = RELUME_ENOMEM;
    if (!status) {
        memcpy(e->scene.places.data, places->data,
               3 * (size_t)width * (size_t)height * sizeof *places->data);
        status = exchange_over_pixels(e, 2, find_layers);
    }
    if (status)
        exchange_destroy(&e);
    *out = e;
    return status;
}

void exchange_stand_before(struct exchange *e, const struct scenery *const *all, int count)
{
    e->before = all;
    e->befores = count;
}

// ---------------------------------------------------------------- the world

static void site_of(struct site *out, const void *context, const struct trace_hit *hit,
                    vec3 direction)
{
    const struct exchange *e = context;
    struct surface_point point;
    objects_point(&point, e->o, hit, direction);
    *out = (struct site){.position = point.position,
                         .normal = point.normal,
                         .start = point_leave(&point),
                         .shines = exchange_shines(e, point.part)};
}

static void sent_by(float rgb[3], const void *context, const struct trace_hit *hit, vec3 origin,
                    vec3 direction, uint64_t key, const struct arrival *arrivals, int n)
{
    const struct exchange *e = context;
    struct lighting lighting = e->lighting;  // its key is this ray's
    struct surface_point point;
    objects_point(&point, e->o, hit, direction);
    lighting.every = ON_THE_WAY;
    lighting.key = random_mix(key);
    objects_shade(rgb, e->o, &point, origin, &lighting);
    for (int i = 0; i < n; i++) {
        float more[3];
        objects_return(more, e->o, &point, origin, &arrivals[i]);
        for (int c = 0; c < 3; c++)
            rgb[c] += more[c];
    }
}

static void returned_by(float rgb[3], const void *context, const struct trace_hit *hit, vec3 origin,
                        vec3 direction, const struct arrival *arrival)
{
    const struct exchange *e = context;
    struct surface_point point;
    objects_point(&point, e->o, hit, direction);
    objects_return(rgb, e->o, &point, origin, arrival);
}

bool exchange_shines(const struct exchange *e, int part)
{
    const struct relume_objects_info *info = relume_objects_info(e->o);
    const struct relume_object_material *m = &info->material[info->part[part].material];
    return !m->mirror && !m->baked && strcmp(m->model, "lit");
}

static void begin_world(struct exchange *e)
{
    const struct relume_objects_info *info = relume_objects_info(e->o);
    const struct relume_render_params *p = &e->params;
    e->world = (struct world){
        .scenery = e->scenery,
        .objects = e->o->tracer,
        .mesh = &e->o->mesh,
        .site = site_of,
        .sent = sent_by,
        .returned = returned_by,
        .dimmed = exchange_dimmed,
        .context = e,
        .viewport = e->viewport,
        .bare = {&e->scene.places, &e->scene.normals, e->lone, NULL},
        .full = {&e->frame.places, &e->frame.normals, &e->shown, e->behind},
        .radius = 0.5 * vec3_length(vec3_sub(info->max, info->min)),
        .samples = p->transport_samples ? p->transport_samples : e->transport->samples,
        .bounces = p->bounces < 0 ? 0
                   : p->bounces   ? p->bounces
                                  : 1,
        .threads = p->threads,
    };
    scenery_mean(e->world.mean, e->scenery);
}

// What a screen shows under the light, for ways that go by it.
static void show(struct exchange *e, int x, int y)
{
    const size_t pixel = exchange_pixel(e, x, y);
    const double middle[2] = {0.5, 0.5};
    float *rgb = e->shown.data + 3 * pixel;
    struct surface_point point;
    if (layer_holds(&e->objects, pixel) && exchange_objects_at(&point, e, x, y)) {
        objects_shade(rgb, e->o, &point, exchange_ray(e, x, y, middle).origin, &e->lighting);
        return;
    }
    const vec3 place = places_at(&e->scene.places, pixel),
               normal = places_at(&e->scene.normals, pixel);
    const double part =
        layer_holds(&e->scene, pixel) ? exchange_dimmed(e, place, normal, pixel) : 1.0;
    for (size_t c = 0; c < 3; c++)
        rgb[c] = (float)part * e->lone->data[3 * pixel + c];
}

// ---------------------------------------------------------------- both as they are

static void light_scene(struct exchange *e, int x, int y)
{
    const size_t pixel = exchange_pixel(e, x, y);
    const vec3 place = places_at(&e->scene.places, pixel),
               normal = places_at(&e->scene.normals, pixel);
    const float *without = e->without.data + 3 * pixel, *with = e->with.data + 3 * pixel;
    const float *lone = e->lone->data + 3 * pixel;
    double part[3] = {1.0, 1.0, 1.0};
    if (layer_holds(&e->scene, pixel) && exchange_keeps_lamps(e)) {
        const struct lit_by lit = exchange_lamps_put(e, pixel);
        exchange_quotient(part, lone, &lit, without, with);
    } else if (layer_holds(&e->scene, pixel) && (memcmp(without, with, 3 * sizeof *with) ||
                                                 exchange_in_shadow(e, place, normal, 1, 0))) {
        const struct lit_by lit = exchange_lamps_at(e, place, normal, 1, 0);
        exchange_quotient(part, lone, &lit, without, with);
    }
    for (size_t c = 0; c < 3; c++)
        e->lit->data[3 * pixel + c] += (float)part[c] * lone[c];
}

// What the objects have gathered is part of what a screen shows to the scene.
static void light_objects(struct exchange *e, int x, int y)
{
    const size_t pixel = 3 * exchange_pixel(e, x, y);
    const bool goes_on = e->world.bounces > 1;
    for (size_t c = pixel; c < pixel + 3; c++) {
        if (e->reflected)
            e->reflected->data[c] += e->returned.data[c];
        e->shown.data[c] += goes_on ? e->returned.data[c] : 0.0f;
    }
}

static void copy_pixels(struct relume_image *to, const struct relume_image *from)
{
    memcpy(to->data, from->data, 3 * (size_t)from->width * (size_t)from->height * sizeof *to->data);
}

// Objects keep their texture: what is smoothed is the light that it is multiplied by, which is what
// they return over what a white surface would, with a little of the same of their neighbours where
// the pixel itself has gathered hardly any.
static relume_status smooth_objects(struct exchange *e)
{
    const float LITTLE = 0.1f;
    if (e->transport->pattern < 2)
        return RELUME_OK;
    struct relume_image white = {0}, returned = {0};
    struct relume_image *const both[] = {&white, &returned};
    relume_status status = relume_image_create(&white, e->white.width, e->white.height, 3);
    if (!status)
        status = relume_image_create(&returned, e->white.width, e->white.height, 3);
    if (!status) {
        copy_pixels(&white, &e->white);
        copy_pixels(&returned, &e->returned);
        status = transport_smooth(both, 2, &e->objects.places, &e->objects.normals, e->eye,
                                  e->transport->pattern, e->params.threads);
    }
    const size_t values = 3 * (size_t)e->white.width * (size_t)e->white.height;
    for (size_t i = 0; i < values && !status; i++) {
        const float light = e->white.data[i] + LITTLE * white.data[i];
        e->returned.data[i] =
            light > 0.0f ? white.data[i] * (e->returned.data[i] + LITTLE * returned.data[i]) / light
                         : 0.0f;
    }
    relume_image_destroy(&white);
    relume_image_destroy(&returned);
    return status;
}

static relume_status smooth_scene(struct exchange *e)
{
    struct relume_image *const both[] = {&e->without, &e->with};
    return transport_smooth(both, 2, &e->scene.places, &e->scene.normals, e->eye,
                            e->transport->pattern, e->params.threads);
}

static relume_status gather_at_all_objects(struct exchange *e, int rays)
{
    relume_status status =
        lighting_gathers(&e->lighting, e->o, &e->world, e->transport, e->params.log);
    if (!status)
        status = exchange_over_pixels(e, rays, exchange_gather_objects);
    if (!status && e->spacing > 1)
        status = exchange_over_pixels(e, rays, exchange_fill_objects);
    if (!status)
        status = smooth_objects(e);
    if (!status && e->share && e->spacing == 1)
        status = transport_smooth(&e->share, 1, &e->objects.places, &e->objects.normals, e->eye,
                                  SKY_PATTERN, e->params.threads);
    exchange_further_gather(e);
    if (!status)
        status = exchange_over_pixels(e, 1, light_objects);
    exchange_further_show(e);
    return status;
}

static relume_status gather(struct exchange *e)
{
    begin_world(e);
    const int lamps = e->lighting.light_samples + 1, rays = e->world.samples * 4;
    const int few = rays / (e->spacing * e->spacing) + 1;
    relume_status status = e->transport->screen ? exchange_over_pixels(e, lamps, show) : RELUME_OK;
    if (!status && e->cameras > 0)
        status = exchange_further_create(e);
    if (!status && e->transport->begin)
        status = e->transport->begin(&e->world, e->params.log);
    if (!status && (e->reflected || e->transport->screen))
        status = gather_at_all_objects(e, few);
    if (!status)
        status = exchange_over_pixels(e, few, exchange_gather_scene);
    if (!status && e->spacing > 1)
        status = exchange_over_pixels(e, few, exchange_fill_scene);
    if (!status)
        status = smooth_scene(e);
    if (e->transport->end)
        e->transport->end(&e->world);
    exchange_further_destroy(e);
    return status ? status : exchange_over_pixels(e, lamps, light_scene);
}

relume_status exchange_light(struct exchange *e, struct relume_image *scene,
                             struct relume_image *reflected, struct relume_image *share,
                             const struct relume_image *lone, const struct relume_light *light)
{
    struct relume_image *const gathered[] = {&e->shown,    &e->without, &e->with,     &e->white,
                                             &e->returned, &e->ahead,   &e->lamps[0], &e->lamps[1],
                                             &e->lamps[2], &e->lamps[3]};
    enum { IMAGES = sizeof gathered / sizeof *gathered };
    e->lone = lone, e->lit = scene, e->reflected = reflected, e->share = share;
    relume_status status = lighting_create(&e->lighting, e->o, light, 1, &e->params);
    e->lighting.sends = e->sends;
    e->lighting.scenery = &e->scenery, e->lighting.sceneries = 1;
    e->lighting.surround.scenery = scenery_is_around(e->scenery) ? e->scenery : NULL;
    if (!status)
        status = lighting_enters(&e->lighting, e->o, e->bodies, e->params.threads, e->params.log);
    for (int i = 0; i < IMAGES && !status; i++)
        status = relume_image_create(gathered[i], lone->width, lone->height, 3);
    if (!status)
        status = gather(e);
    for (int i = 0; i < IMAGES; i++)
        relume_image_destroy(gathered[i]);
    lighting_destroy(&e->lighting);
    return status;
}
