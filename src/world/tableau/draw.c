// draw.c - what an eye sees of a scene of several captures and objects
//
// In each pixel the nearest capture owns the place; objects are drawn over that. Light by light the
// captures are relit, each pixel times the share of the light that the other captures and the
// objects let through (or, with transport, as object.h says of the first capture).
#include "world/tableau/tableau.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "relight/view/slab_set.h"
#include "shape/mesh/places.h"
#include "world/object/drawn_objects.h"
#include "world/object/levels.h"
#include "world/tableau/which.h"

#include <string.h>

enum { NONE = -1 };
static const double FARTHEST = 1e15;  // rays are of single precision

// A frame of the captures that are shown.
struct drawing {
    relume_tableau *t;
    struct relume_render_params params;
    struct relume_camera camera;
    struct relume_viewport viewport;
    const relume_objects *objects;       // as the eye sees them
    bool *shown;                         // [captures]
    struct relume_image *seen, *colour;  // [captures]: places, and what is seen there
    struct relume_image places, lone, scene, reflected;
    int *owner;                      // [pixels]: capture, NONE
    const struct scenery **scenery;  // [sceneries]: of captures that are shown
    int sceneries;
    struct exchange *exchange;
    struct relume_image *shares;  // [lights], of environments first: which share reaches objects
    int lights, skies;
    struct lighting lighting;
    const struct relume_object_light *light_sample;
    int light_samples;
    float rest[3];  // what comes from everywhere; without transport 0
};

static size_t pixels_of(const struct drawing *d)
{
    return (size_t)d->camera.width * (size_t)d->camera.height;
}

// ---------------------------------------------------------------- what is where

static void find_owner(void *context, size_t row, int worker)
{
    (void)worker;
    struct drawing *d = context;
    const size_t width = (size_t)d->camera.width;
    for (size_t pixel = row * width; pixel < (row + 1) * width; pixel++) {
        double least = INFINITY;
        float *to = d->places.data + 3 * pixel;
        d->owner[pixel] = NONE;
        to[0] = to[1] = to[2] = NAN;
        for (int i = 0; i < d->t->info.captures; i++) {
            if (!d->shown[i])
                continue;
            const vec3 place = places_at(&d->seen[i], pixel);
            const double distance = vec3_length(vec3_sub(place, d->camera.eye));
            if (!(distance < least))
                continue;
            least = distance;
            d->owner[pixel] = i;
            memcpy(to, d->seen[i].data + 3 * pixel, 3 * sizeof *to);
        }
    }
}

static bool find_window(struct relume_window *window, const struct relume_camera *camera)
{
    return relume_slab_set_window(window, NULL, camera->eye, &camera->look_at, camera->width,
                                  camera->height);
}

static relume_status take_camera(struct drawing *d, const struct relume_camera *camera)
{
    const struct relume_camera *own = &d->t->info.camera;
    const int size[2] = {own->width, own->height};
    d->camera = *own;
    if (camera && camera->framing == RELUME_FRAME_EYE)
        d->camera.eye = camera->eye;
    if (camera &&
        (camera->framing == RELUME_FRAME_EYE || camera->framing == RELUME_FRAME_DEFAULT)) {
        if (camera->look_at.aimed)
            d->camera.look_at.at = camera->look_at.at;
        if (!vec3_is_zero(camera->look_at.up))
            d->camera.look_at.up = camera->look_at.up;
        if (camera->look_at.field_of_view_deg != 0.0)
            d->camera.look_at.field_of_view_deg = camera->look_at.field_of_view_deg;
    }
    if (camera)
        relume_frame_size(&d->camera.width, &d->camera.height, size, camera);
    d->viewport = (struct relume_viewport){
        .kind = RELUME_VIEWPORT_PERSPECTIVE, .width = d->camera.width, .height = d->camera.height};
    if (vec3_length(d->camera.eye) > FARTHEST || vec3_length(d->camera.look_at.at) > FARTHEST)
        return log_fail(d->t->params.log, RELUME_EINVAL,
                        "%s: expected an eye and a place looked at within %g of the middle",
                        d->t->path, FARTHEST);
    if (find_window(&d->viewport.window, &d->camera))
        return RELUME_OK;
    return log_fail(d->t->params.log, RELUME_EINVAL,
                    "%s: the eye stands where it looks, or looks along the direction that is up",
                    d->t->path);
}

static relume_status allocate_drawing(struct drawing *d)
{
    enum { PIXEL_BYTES = 5 * 3 * sizeof(float) + sizeof(int) };
    const size_t captures = (size_t)d->t->info.captures;
    const relume_status status =
        limits_memory(NULL, pixels_of(d) * (PIXEL_BYTES + captures * 2 * 3 * sizeof(float)),
                      "a picture of this size of several captures", d->t->params.log);
    if (status)
        return status;
    d->shown = mem_zeroed(captures, sizeof *d->shown);
    d->seen = mem_zeroed(captures, sizeof *d->seen);
    d->colour = mem_zeroed(captures, sizeof *d->colour);
    d->scenery = mem_zeroed(captures, sizeof *d->scenery);
    d->owner = mem_array(pixels_of(d), sizeof *d->owner);
    return d->shown && d->seen && d->colour && d->scenery && d->owner
               ? relume_image_create(&d->places, d->camera.width, d->camera.height, 3)
               : RELUME_ENOMEM;
}

static relume_status begin(struct drawing *d, relume_tableau *t, const struct relume_camera *camera)
{
    d->t = t;
    relume_status status = take_camera(d, camera);
    if (!status)
        status = allocate_drawing(d);
    if (!status)
        status =
            tableau_choose(d->shown, t, &d->viewport.window, d->camera.width, d->camera.height);
    for (int i = 0; i < t->info.captures && !status; i++) {
        if (!d->shown[i])
            continue;
        d->scenery[d->sceneries++] = t->capture[i].scenery;
        status = exhibit_places(&d->seen[i], &t->capture[i], &d->camera, &d->viewport.window,
                                t->params.threads);
    }
    if (!status)
        thread_for(t->params.threads, (size_t)d->camera.height, find_owner, d);
    return status;
}

static void end(struct drawing *d)
{
    for (int i = 0; i < d->t->info.captures; i++) {
        if (d->seen)
            relume_image_destroy(&d->seen[i]);
        if (d->colour)
            relume_image_destroy(&d->colour[i]);
    }
    exchange_destroy(&d->exchange);
    for (int i = 0; i < d->lights && d->shares; i++)
        relume_image_destroy(&d->shares[i]);
    mem_free(d->shares);
    lighting_destroy(&d->lighting);
    relume_image_destroy(&d->places);
    relume_image_destroy(&d->lone);
    relume_image_destroy(&d->scene);
    relume_image_destroy(&d->reflected);
    mem_free(d->shown);
    mem_free(d->seen);
    mem_free(d->colour);
    mem_free(d->scenery);
    mem_free(d->owner);
}

// ---------------------------------------------------------------- light

// Whether no capture but its own stands between a place and a lamp.
static bool is_reached(const struct drawing *d, const struct scenery *own, vec3 place, vec3 normal,
                       vec3 towards, double distance)
{
    bool is = true;
    for (int i = 0; i < d->sceneries && is; i++)
        is = d->scenery[i] == own ||
             scenery_reached(d->scenery[i], scenery_leave(d->scenery[i], place, normal), towards,
                             distance);
    return is;
}

// The share of the light samples, each by what it sends times its cosine, that gets past the other
// captures. With transport, what else a place is lit by is taken to be what comes from everywhere,
// and gets past them.
static double share_of(const struct drawing *d, const struct scenery *own, vec3 place, vec3 normal)
{
    const double rest = (double)(d->rest[0] + d->rest[1] + d->rest[2]);
    double sent = 0.0, arrived = 0.0;
    for (int i = 0; i < d->light_samples; i++) {
        float rgb[3];
        double distance;
        vec3 towards;
        if (!relume_object_light_at(&towards, rgb, &distance, &d->light_sample[i], place))
            continue;
        const double value = (double)(rgb[0] + rgb[1] + rgb[2]) *
                             (d->light_samples > 1 ? fmax(vec3_dot(normal, towards), 0.0) : 1.0);
        sent += value;
        if (value > 0.0 && is_reached(d, own, place, normal, towards, distance))
            arrived += value;
    }
    return sent > 0.0 ? (rest + arrived) / (rest + sent) : 1.0;
}

// A pixel of no capture shows what lies far behind the first.
static void light_row(void *context, size_t row, int worker)
{
    (void)worker;
    struct drawing *d = context;
    const size_t width = (size_t)d->camera.width;
    for (size_t x = 0; x < width; x++) {
        const size_t pixel = row * width + x;
        const int owner = d->owner[pixel];
        const struct relume_image *shows = owner != NONE         ? &d->colour[owner]
                                           : d->t->info.captures ? &d->colour[0]
                                                                 : NULL;
        const vec3 place = places_at(&d->places, pixel);
        double part = 1.0;
        if (owner != NONE && d->sceneries > 1 && !d->params.no_shadows)
            part = share_of(d, d->t->capture[owner].scenery, place,
                            scene_normal(&d->places, (int)x, (int)row));
        for (size_t c = 0; c < 3; c++)
            d->lone.data[3 * pixel + c] =
                shows && shows->data ? (float)part * shows->data[3 * pixel + c] : 0.0f;
    }
}

// The sum of the first capture's own views, for mirrors.
static relume_status add_surround(struct drawing *d)
{
    struct relume_image *sum = &d->lighting.surround.panorama;
    const struct relume_image *relit = &d->t->capture[0].relit;
    if (!d->lighting.surround.geometry)
        return RELUME_OK;
    if (!sum->data) {
        const relume_status status = relume_image_create(sum, relit->width, relit->height, 3);
        if (status)
            return status;
    }
    for (size_t i = 0; i < 3 * (size_t)relit->width * (size_t)relit->height; i++)
        sum->data[i] += relit->data[i];
    return RELUME_OK;
}

static relume_status relight_captures(struct drawing *d, const struct relume_light *light)
{
    relume_status status = RELUME_OK;
    for (int i = 0; i < d->t->info.captures && !status; i++) {
        relume_image_destroy(&d->colour[i]);
        if (d->shown[i])
            status = exhibit_light(&d->colour[i], &d->t->capture[i], &d->camera,
                                   &d->viewport.window, &d->seen[i], light, &d->params);
    }
    return status;
}

// Where the share of an environment goes that exchange_light finds.
static relume_status need_share(struct relume_image **out, struct drawing *d,
                                const struct relume_light *light)
{
    *out = NULL;
    if (!d->exchange || light->kind != RELUME_LIGHT_ENVIRONMENT)
        return RELUME_OK;
    *out = &d->shares[d->skies++];
    return relume_image_create(*out, d->camera.width, d->camera.height, 3);
}

static relume_status add_light(struct drawing *d, const struct relume_light *light)
{
    struct relume_image *share;
    relume_tableau *t = d->t;
    struct relume_object_light *light_samples;
    const size_t rows = (size_t)d->camera.height;
    relume_status status = relight_captures(d, light);
    if (!status)
        status = relume_objects_lights(&light_samples, &d->light_samples, d->objects, light, 1);
    if (status)
        return status;
    d->light_sample = light_samples;
    if (d->exchange)
        status =
            scenery_light(t->capture[0].scenery, &t->capture[0].relit, objects_middle(d->objects));
    if (!status && d->exchange)
        scenery_mean(d->rest, t->capture[0].scenery);
    if (!status)
        status = add_surround(d);
    if (!status)
        thread_for(d->params.threads, rows, light_row, d);
    if (!status)
        status = need_share(&share, d, light);
    if (!status && d->exchange)
        status = exchange_light(d->exchange, &d->scene, &d->reflected, share, &d->lone, light);
    else if (!status)
        scene_add(&(struct scene_in_shadow){d->objects, &d->places, &d->lone, &d->scene,
                                            light_samples, d->light_samples, d->params.no_shadows},
                  d->params.threads);
    mem_free(light_samples);
    return status;
}

// ---------------------------------------------------------------- frames

static relume_status begin_exchange(struct drawing *d, int lights)
{
    relume_tableau *t = d->t;
    if (!render_exchanges(&d->params) || !d->objects->info.triangle_count) {
        d->params.transport = NULL;
        return RELUME_OK;
    }
    if (!t->info.captures)
        return log_fail(t->params.log, RELUME_EUNFIT,
                        "%s: light goes between objects and a capture, and there is none; leave "
                        "out the transport",
                        t->path);
    relume_status status = relume_image_create(&d->reflected, d->camera.width, d->camera.height, 3);
    d->shares = mem_zeroed((size_t)lights, sizeof *d->shares);
    d->lights = lights;
    if (!status && !d->shares)
        status = RELUME_ENOMEM;
    if (!status)
        status = exchange_create(&d->exchange, d->objects, lights, t->bodies, t->capture[0].scenery,
                                 &d->viewport, &d->places, &d->params);
    if (!status)
        exchange_stand_before(d->exchange, d->scenery, d->sceneries);
    return status;
}

static relume_status begin_lighting(struct drawing *d, const struct relume_light *lights, int n)
{
    relume_tableau *t = d->t;
    const struct relume_geometry *g =
        t->info.captures ? &relume_pack_info(t->capture[0].pack)->geometry : NULL;
    relume_status status = lighting_create(&d->lighting, d->objects, lights, n, &d->params);
    d->lighting.scenery = d->scenery, d->lighting.sceneries = d->sceneries;
    if (!status && g && g->projection >= RELUME_CYLINDRICAL && objects_have_mirrors(d->objects)) {
        d->lighting.surround.geometry = g;
        status = exhibit_whole_places(&d->lighting.surround.places, &t->capture[0]);
    }
    if (!status)
        status = bodies_need(&t->bodies, d->objects, t->params.threads, t->params.log);
    if (!status)
        status =
            lighting_enters(&d->lighting, d->objects, t->bodies, t->params.threads, t->params.log);
    if (!status && !t->said_black && surround_lacks(&d->lighting.surround, d->objects)) {
        log_line(t->params.log, RELUME_WARNING, "%s", SURROUND_LACKS);
        t->said_black = true;
    }
    return status;
}

relume_status relume_tableau_frame(struct relume_image *out, relume_tableau *tableau,
                                   const struct relume_camera *camera,
                                   const struct relume_light *lights, int n,
                                   const struct relume_render_params *params)
{
    struct drawing d = {.params = PARAMS_WORK(relume_render_params, params)};
    *out = (struct relume_image){0};
    if (!render_params_good(&d.params))
        return RELUME_EINVAL;
    relume_status status = begin(&d, tableau, camera);
    if (!status)
        status = relume_objects_shown(&tableau->shown, tableau->objects, d.camera.eye,
                                      objects_pixel_of_viewport(&d.viewport), true);
    d.objects = objects_or(tableau->shown, tableau->objects);
    if (!status)
        objects_say_around(&tableau->said_within, d.objects, d.camera.eye, d.params.log);
    if (!status)
        status = relume_image_create(&d.lone, d.camera.width, d.camera.height, 3);
    if (!status)
        status = relume_image_create(&d.scene, d.camera.width, d.camera.height, 3);
    if (!status)
        status = begin_lighting(&d, lights, n);
    if (!status)
        status = begin_exchange(&d, n);
    for (int i = 0; i < n && !status; i++) {
        status = add_light(&d, &lights[i]);
        if (!status && !log_progress(d.params.log, "relighting the scene", (i + 1.0) / n))
            status = RELUME_ECANCEL;
    }
    const struct layered layers = {.o = d.objects,
                                   .viewport = &d.viewport,
                                   .scene = &d.scene,
                                   .places = &d.places,
                                   .reflected = &d.reflected,
                                   .shares = d.shares,
                                   .lighting = &d.lighting};
    if (!status)
        status = objects_layer(out, &layers, &d.params);
    if (status)
        relume_image_destroy(out);
    end(&d);
    return status;
}

// The number in the file of an object among those that are shown.
static int entity_of(const relume_tableau *t, int object)
{
    int i = 0;
    for (; i < tableau_objects(t); i++)
        if (!t->left_out[i] && object-- == 0)
            break;
    return t->info.captures + i;
}

static void which_row(void *context, size_t row, int worker)
{
    (void)worker;
    struct drawing *d = context;
    const relume_tableau *t = d->t;
    const size_t width = (size_t)d->camera.width;
    for (size_t x = 0; x < width; x++) {
        const size_t pixel = row * width + x;
        const vec3 place = places_at(&d->places, pixel);
        struct surface_point point;
        struct ray ray;
        relume_viewport_ray(&ray.origin, &ray.direction, &d->viewport, (double)x + 0.5,
                            (double)row + 0.5);
        const bool is = objects_hit(&point, t->objects, ray.origin, ray.direction) &&
                        !(point.distance >= vec3_length(vec3_sub(place, ray.origin)));
        d->scene.data[pixel] =
            (float)(is ? entity_of(t, t->objects->part[point.part].object) : d->owner[pixel]);
    }
}

relume_status relume_tableau_which(struct relume_image *out, relume_tableau *tableau,
                                   const struct relume_camera *camera)
{
    struct drawing d = {.t = tableau};
    *out = (struct relume_image){0};
    relume_status status = begin(&d, tableau, camera);
    if (!status)
        status = relume_image_create(&d.scene, d.camera.width, d.camera.height, 1);
    if (!status) {
        thread_for(tableau->params.threads, (size_t)d.camera.height, which_row, &d);
        *out = d.scene;
        d.scene = (struct relume_image){0};
    }
    end(&d);
    return status;
}
