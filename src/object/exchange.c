// exchange.c - light between a captured scene and the objects in it (relume/transport.h), at the
// pixels of a frame
//
// A frame has two layers: the scene, and the objects where they are before it. For each light of
// the rig the way of transport gathers what arrives at every pixel of both; what neighbours have
// gathered is smoothed over surfaces. A pixel of the scene becomes
//     shown * (lamps with objects + gathered with) / (lamps + gathered without)
// where the lamps are those that the captured mesh lets through. Where nothing differs the quotient
// is exactly 1.
#include "base/log.h"
#include "base/memory.h"
#include "base/params.h"
#include "base/thread.h"
#include "math/random.h"
#include "math/scalar.h"
#include "object/object.h"

#include <string.h>

// Of the samples of an environment one in so many is looked for where light is on its way.
enum { ON_THE_WAY = 8 };

// What lamps show a white matte surface, without and with the objects: those that the scene lets
// through, and all.
enum { LET_THROUGH, LET_THROUGH_WITH, ALL, ALL_WITH, LAMPS };

struct layer {
    struct relume_image places, normals;  // NaN: nothing is there
};

struct exchange {
    const relume_objects *o;
    const struct scenery *scenery;
    const struct relume_viewport *viewport;
    const struct relume_transport *transport;
    struct relume_render_params params;
    int spacing;  // pixels from one that gathers to the next
    const struct bodies *bodies;
    struct layer scene, objects, frame;
    float *behind;  // [pixels]: how far off the eye the backs of objects are
    vec3 eye;
    // Of the light in hand.
    struct lighting lighting;
    struct world world;
    const struct relume_image *lone;
    struct relume_image *lit, *reflected, *share;
    struct relume_image shown;            // what the frame shows, without light between
    struct relume_image without, with;    // gathered by the scene
    struct relume_image white, returned;  // by the objects: of white ones, and as they are
    struct relume_image ahead;            // what objects return of light of 1 from straight ahead
    struct relume_image lamps[LAMPS];     // before the scene, for lights of many samples
};

// ---------------------------------------------------------------- pixels

static size_t pixel_of(const struct exchange *e, int x, int y)
{
    return (size_t)y * (size_t)e->scene.places.width + (size_t)x;
}

static vec3 three(const struct relume_image *image, size_t pixel)
{
    const float *p = image->data + 3 * pixel;
    return vec3_of((double)p[0], (double)p[1], (double)p[2]);
}

static void put(const struct relume_image *image, size_t pixel, vec3 v)
{
    float *p = image->data + 3 * pixel;
    p[0] = (float)v.x, p[1] = (float)v.y, p[2] = (float)v.z;
}

static bool holds(const struct layer *layer, size_t pixel)
{
    return !isnan(layer->places.data[3 * pixel]);
}

typedef void do_pixel(struct exchange *e, int x, int y);

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

// `rays` for each pixel or so: who stops does not wait for more than some of them.
static relume_status over_pixels(struct exchange *e, int rays, do_pixel *pixel)
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

static struct ray ray_of(const struct exchange *e, int x, int y, const double at[2])
{
    struct ray ray;
    relume_viewport_ray(&ray.origin, &ray.direction, e->viewport, x + at[0], y + at[1]);
    return ray;
}

// The objects as the middle of a pixel shows them, or else some other part of it: pixels along
// their outline need their light, too.
static bool objects_at(struct surface_point *point, const struct exchange *e, int x, int y)
{
    static const double within[][2] = {{0.5, 0.5}, {0.2, 0.2}, {0.8, 0.2}, {0.2, 0.8}, {0.8, 0.8}};
    const vec3 scene = three(&e->scene.places, pixel_of(e, x, y));
    for (size_t i = 0; i < sizeof within / sizeof *within; i++) {
        const struct ray ray = ray_of(e, x, y, within[i]);
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
    const size_t pixel = pixel_of(e, x, y);
    const vec3 place = three(&e->scene.places, pixel), nowhere = vec3_of(NAN, NAN, NAN);
    vec3 normal = scene_normal(&e->scene.places, x, y);
    const vec3 to_eye = vec3_unit(vec3_sub(e->eye, place));
    if (vec3_is_zero(normal))
        normal = to_eye;
    if (vec3_dot(normal, to_eye) < 0.0)
        normal = vec3_scale(normal, -1.0);
    struct surface_point point;
    const bool is = objects_at(&point, e, x, y);
    put(&e->scene.normals, pixel, normal);
    put(&e->objects.places, pixel, is ? point.position : nowhere);
    put(&e->objects.normals, pixel, is ? point.normal : nowhere);
    e->behind[pixel] = is ? (float)back_of(e, &point) : INFINITY;
    put(&e->frame.places, pixel, is ? point.position : place);
    put(&e->frame.normals, pixel, is ? point.normal : normal);
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

relume_status exchange_create(struct exchange **out, const relume_objects *o,
                              const struct bodies *bodies, const struct scenery *scenery,
                              const struct relume_viewport *viewport,
                              const struct relume_image *places,
                              const struct relume_render_params *params)
{
    enum { PIXEL_BYTES = 19 * 3 * sizeof(float) };  // images of three numbers, at once
    const int width = places->width, height = places->height;
    *out = NULL;
    relume_status status =
        limits_memory((uint64_t)width * (uint64_t)height * PIXEL_BYTES,
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
                           .spacing = spacing_of(params),
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
        status = over_pixels(e, 2, find_layers);
    }
    if (status)
        exchange_destroy(&e);
    *out = e;
    return status;
}

// ---------------------------------------------------------------- lamps

// What lamps show a white matte surface at a pixel: those that the scene lets through, and all.
struct lamps {
    double let_through[3], all[3];
};
struct lit_by {
    struct lamps without, with;  // the objects
};

static void add_lamp(struct lamps *lamps, bool let_through, double cosine, const float rgb[3])
{
    for (int c = 0; c < 3; c++) {
        lamps->all[c] += cosine * (double)rgb[c];
        lamps->let_through[c] += let_through ? cosine * (double)rgb[c] : 0.0;
    }
}

// One lamp in `every` is looked for.
static struct lit_by lamps_at(const struct exchange *e, vec3 place, vec3 normal, int every,
                              uint64_t key)
{
    const vec3 start = scenery_leave(e->scenery, place, normal);
    struct lit_by lit = {0};
    for (int i = (int)(key % (uint64_t)every); i < e->lighting.light_samples; i += every) {
        float rgb[3];
        double distance;
        vec3 towards;
        if (!relume_object_light_at(&towards, rgb, &distance, &e->lighting.light_sample[i], place))
            continue;
        const double cosine = vec3_dot(towards, normal);
        if (!(cosine > 0.0))
            continue;
        const bool through = scenery_reached(e->scenery, start, towards, distance);
        add_lamp(&lit.without, through, cosine, rgb);
        if (objects_reached(e->o, place, vec3_of(0, 0, 0), towards, distance))
            add_lamp(&lit.with, through, cosine, rgb);
    }
    return lit;
}

static void put_lamps(const struct exchange *e, size_t pixel, vec3 place, vec3 normal)
{
    const struct lit_by lit = lamps_at(e, place, normal, 1, 0);
    for (size_t c = 0; c < 3; c++) {
        e->lamps[LET_THROUGH].data[3 * pixel + c] = (float)lit.without.let_through[c];
        e->lamps[LET_THROUGH_WITH].data[3 * pixel + c] = (float)lit.with.let_through[c];
        e->lamps[ALL].data[3 * pixel + c] = (float)lit.without.all[c];
        e->lamps[ALL_WITH].data[3 * pixel + c] = (float)lit.with.all[c];
    }
}

static struct lit_by lamps_put(const struct exchange *e, size_t pixel)
{
    struct lit_by lit;
    for (size_t c = 0; c < 3; c++) {
        lit.without.let_through[c] = (double)e->lamps[LET_THROUGH].data[3 * pixel + c];
        lit.with.let_through[c] = (double)e->lamps[LET_THROUGH_WITH].data[3 * pixel + c];
        lit.without.all[c] = (double)e->lamps[ALL].data[3 * pixel + c];
        lit.with.all[c] = (double)e->lamps[ALL_WITH].data[3 * pixel + c];
    }
    return lit;
}

static double sum_of(const double rgb[3])
{
    return rgb[0] + rgb[1] + rgb[2];
}

static bool is_in_shadow(const struct exchange *e, vec3 place, vec3 normal, int every, uint64_t key)
{
    return scene_share(e->o, e->lighting.light_sample, e->lighting.light_samples, place, normal,
                       every, key) < 1.0;
}

// Of what a place of the scene shows, the part that it shows in the shadow of the objects. All else
// that it is lit by is taken to be what comes from everywhere.
static double dimmed(const void *context, vec3 place, vec3 normal, uint64_t key)
{
    const struct exchange *e = context;
    const int every = e->lighting.light_samples > ON_THE_WAY ? ON_THE_WAY : 1;
    key = random_mix(key);
    if (!is_in_shadow(e, place, normal, every, key))
        return 1.0;
    const struct lit_by lit = lamps_at(e, place, normal, every, key);
    const float *mean = e->world.mean;
    const double rest = (double)(mean[0] + mean[1] + mean[2]) / every;
    const double before = rest + sum_of(lit.without.let_through);
    return before > 0.0 ? (rest + sum_of(lit.with.let_through)) / before : 1.0;
}

// ---------------------------------------------------------------- the world

static void site_of(struct site *out, const void *context, const struct trace_hit *hit,
                    vec3 direction)
{
    const struct exchange *e = context;
    struct surface_point point;
    objects_point(&point, e->o, hit, direction);
    *out = (struct site){
        .position = point.position, .normal = point.normal, .start = point_leave(&point)};
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
        .dimmed = dimmed,
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

// ---------------------------------------------------------------- gathering

static uint64_t key_of(const struct exchange *e, int x, int y)
{
    const int n = e->transport->pattern;
    return n > 1 ? (uint64_t)(x % n + n * (y % n)) : random_mix(pixel_of(e, x, y));
}

static void add(float sum[3], double share, const float rgb[3])
{
    for (int c = 0; c < 3; c++)
        sum[c] += (float)share * rgb[c];
}

struct at_scene {
    float *without, *with;
};

static void arrive_at_scene(void *context, const struct arrival *a)
{
    const struct at_scene *s = context;
    add(s->without, a->share, a->without);
    add(s->with, a->share, a->with);
}

struct at_objects {
    const struct exchange *e;
    const struct surface_point *point;
    vec3 eye;
    float *white, *returned;
};

static void arrive_at_objects(void *context, const struct arrival *a)
{
    const struct at_objects *s = context;
    float rgb[3];
    add(s->white, a->share, a->with);
    objects_return(rgb, s->e->o, s->point, s->eye, a);
    add(s->returned, 1.0, rgb);
}

static void gather_scene(struct exchange *e, int x, int y)
{
    const size_t pixel = pixel_of(e, x, y);
    const vec3 place = three(&e->scene.places, pixel), normal = three(&e->scene.normals, pixel);
    struct at_scene at = {e->without.data + 3 * pixel, e->with.data + 3 * pixel};
    const struct site site = {.position = place,
                              .normal = normal,
                              .start =
                                  e->scenery ? scenery_leave(e->scenery, place, normal) : place,
                              .key = key_of(e, x, y)};
    e->transport->gather(&e->world, &site, arrive_at_scene, &at);
}

static void gather_at_point(struct exchange *e, const struct surface_point *point,
                            struct at_objects *at, uint64_t key)
{
    if (translucent_return(at->returned, &e->lighting, point, at->eye)) {
        at->white[0] = at->white[1] = at->white[2] = 1.0f;  // has been smoothed below its surface
        return;
    }
    const struct site site = {.position = point->position,
                              .normal = point->normal,
                              .start = point_leave(point),
                              .key = key};
    e->transport->gather(&e->world, &site, arrive_at_objects, at);
}

// Of a mirror, what is seen in it.
static void gather_objects(struct exchange *e, int x, int y, const struct surface_point *point)
{
    const size_t pixel = pixel_of(e, x, y);
    const double middle[2] = {0.5, 0.5};
    struct surface_point seen = *point;
    struct mirrored mirrored = {.part = {1.0f, 1.0f, 1.0f}};
    struct at_objects at = {e, &seen, ray_of(e, x, y, middle).origin, e->white.data + 3 * pixel,
                            e->returned.data + 3 * pixel};
    if (objects_mirror_at(e->o, point)) {
        mirror_follow(&mirrored, e->o, point, at.eye, &e->lighting);
        if (!mirrored.meets)
            return;
        seen = mirrored.point;
        at.eye = mirrored.from;
    }
    gather_at_point(e, &seen, &at, key_of(e, x, y));
    for (int c = 0; c < 3; c++)
        at.returned[c] *= mirrored.part[c];
}

// Shadows of one lamp are sharp; those of many samples are soft.
static bool keeps_lamps(const struct exchange *e)
{
    return e->spacing > 1 && e->lighting.light_samples > 1;
}

static void gather_lamps(struct exchange *e, size_t pixel)
{
    put_lamps(e, pixel, three(&e->scene.places, pixel), three(&e->scene.normals, pixel));
}

static void gather_at_scene(struct exchange *e, int x, int y)
{
    const size_t pixel = pixel_of(e, x, y);
    if (!transport_gathers(e->spacing, x, y) || !holds(&e->scene, pixel))
        return;
    gather_scene(e, x, y);
    if (keeps_lamps(e))
        gather_lamps(e, pixel);
}

static void look_ahead(float rgb[3], const struct exchange *e, const struct surface_point *point)
{
    const struct arrival a = {.towards = point->normal, .share = 1.0, .with = {1.0f, 1.0f, 1.0f}};
    objects_return(rgb, e->o, point, e->eye, &a);
}

static void put_share(const struct exchange *e, size_t pixel, const struct surface_point *point)
{
    if (e->share)
        share_of_sky(e->share->data + 3 * pixel, e->o, point, &e->lighting, 0);
}

static void gather_at_objects(struct exchange *e, int x, int y)
{
    const size_t pixel = pixel_of(e, x, y);
    struct surface_point point;
    if (e->share)
        put(e->share, pixel, vec3_of(NAN, NAN, NAN));
    if (!transport_gathers(e->spacing, x, y) || !holds(&e->objects, pixel) ||
        !objects_at(&point, e, x, y))
        return;
    gather_objects(e, x, y, &point);
    put_share(e, pixel, &point);
    if (e->spacing > 1)
        look_ahead(e->ahead.data + 3 * pixel, e, &point);
}

static void between(float out[3], const struct between_pixels *b, const struct relume_image *image)
{
    double sum[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < b->count; i++)
        for (size_t c = 0; c < 3; c++)
            sum[c] += b->weight[i] * (double)image->data[3 * b->pixel[i] + c];
    for (int c = 0; c < 3; c++)
        out[c] = (float)sum[c];
}

// Whether what pixels have gathered, over what they would have, differs by more than a tenth: a
// pixel between them shows a border.
static bool differ(const struct between_pixels *b, const struct relume_image *over,
                   const struct relume_image *under)
{
    const double SAME = 0.1;
    double least = INFINITY, most = 0.0;
    for (int i = 0; i < b->count; i++) {
        const float *o = over->data + 3 * b->pixel[i],
                    *u = under ? under->data + 3 * b->pixel[i] : NULL;
        const double below = u ? (double)(u[0] + u[1] + u[2]) : 1.0;
        const double part = below > 0.0 ? (double)(o[0] + o[1] + o[2]) / below : 1.0;
        least = fmin(least, part);
        most = fmax(most, part);
    }
    return most - least > SAME * most;
}

static void fill_lamps(struct exchange *e, size_t pixel, const struct between_pixels *b)
{
    if (!b->count || differ(b, &e->lamps[LET_THROUGH_WITH], &e->lamps[LET_THROUGH]) ||
        differ(b, &e->lamps[ALL_WITH], &e->lamps[ALL])) {
        gather_lamps(e, pixel);
        return;
    }
    for (int k = 0; k < LAMPS; k++)
        between(e->lamps[k].data + 3 * pixel, b, &e->lamps[k]);
}

static void fill_scene(struct exchange *e, int x, int y)
{
    const size_t pixel = pixel_of(e, x, y);
    struct between_pixels b;
    if (transport_gathers(e->spacing, x, y) || !holds(&e->scene, pixel))
        return;
    transport_between(&b, e->spacing, x, y, &e->scene.places, &e->scene.normals, e->eye);
    if (!b.count || differ(&b, &e->with, &e->without)) {
        gather_scene(e, x, y);
    } else {
        between(e->without.data + 3 * pixel, &b, &e->without);
        between(e->with.data + 3 * pixel, &b, &e->with);
    }
    if (keeps_lamps(e))
        fill_lamps(e, pixel, &b);
}

// Objects keep their texture: what is taken from the pixels around is what they return over what
// they do of light from straight ahead.
static void fill_objects(struct exchange *e, int x, int y)
{
    const size_t pixel = pixel_of(e, x, y);
    struct surface_point point;
    struct between_pixels b;
    float own[3], ahead[3], *returned = e->returned.data + 3 * pixel;
    if (transport_gathers(e->spacing, x, y) || !holds(&e->objects, pixel) ||
        !objects_at(&point, e, x, y))
        return;
    transport_between(&b, e->spacing, x, y, &e->objects.places, &e->objects.normals, e->eye);
    if (e->share && b.count && !differ(&b, e->share, NULL))
        between(e->share->data + 3 * pixel, &b, e->share);
    else
        put_share(e, pixel, &point);
    if (!b.count || differ(&b, &e->white, NULL) || objects_mirror_at(e->o, &point) ||
        translucent_body(&e->lighting, point.part) >= 0) {
        gather_objects(e, x, y, &point);
        return;
    }
    between(e->white.data + 3 * pixel, &b, &e->white);
    between(returned, &b, &e->returned);
    between(ahead, &b, &e->ahead);
    look_ahead(own, e, &point);
    for (size_t c = 0; c < 3; c++)
        returned[c] = ahead[c] > 0.0f ? returned[c] * own[c] / ahead[c]
                                      : own[c] * e->white.data[3 * pixel + c];
}

// What a screen shows under the light, for ways that go by it.
static void show(struct exchange *e, int x, int y)
{
    const size_t pixel = pixel_of(e, x, y);
    const double middle[2] = {0.5, 0.5};
    float *rgb = e->shown.data + 3 * pixel;
    struct surface_point point;
    if (holds(&e->objects, pixel) && objects_at(&point, e, x, y)) {
        objects_shade(rgb, e->o, &point, ray_of(e, x, y, middle).origin, &e->lighting);
        return;
    }
    const vec3 place = three(&e->scene.places, pixel), normal = three(&e->scene.normals, pixel);
    const double part = holds(&e->scene, pixel) ? dimmed(e, place, normal, pixel) : 1.0;
    for (size_t c = 0; c < 3; c++)
        rgb[c] = (float)part * e->lone->data[3 * pixel + c];
}

// ---------------------------------------------------------------- both as they are

// Whether lamps count that depth is thought to hide, 0 to 1. Shadows of the captured mesh lie a
// pixel beside the captured ones: no surface reflects more than all of the light, so a pixel that
// shows more than arrives is lit by them.
static double hidden_count(const double least[3], const struct lit_by *lit, const float without[3])
{
    const double gathered = (double)(without[0] + without[1] + without[2]);
    const double arrives = sum_of(lit->without.let_through) + gathered;
    return smoothstep(1.0, 1.5, arrives > 0.0 ? sum_of(least) / arrives : INFINITY);
}

static double lamp(const struct lamps *lamps, double hidden, int c)
{
    return lamps->let_through[c] + hidden * (lamps->all[c] - lamps->let_through[c]);
}

// What a pixel that shows `shown` is multiplied by. Where even with all lamps less arrives than it
// shows, the rest is light that nothing is known of, which no object hides.
static void quotient(double part[3], const float shown[3], const struct lit_by *lit,
                     const float without[3], const float with[3])
{
    const double least[3] = {(double)shown[0], (double)shown[1], (double)shown[2]};
    const double hidden = hidden_count(least, lit, without);
    for (int c = 0; c < 3; c++) {
        const double before = lamp(&lit->without, hidden, c) + (double)without[c];
        const double after = lamp(&lit->with, hidden, c) + (double)with[c];
        const double unknown = fmax(least[c] - before, 0.0);
        const bool shows = least[c] > 0.0;  // few captured lights also foretell less than none
        part[c] = shows && before + unknown > 0.0 ? (after + unknown) / (before + unknown) : 1.0;
    }
}

static void light_scene(struct exchange *e, int x, int y)
{
    const size_t pixel = pixel_of(e, x, y);
    const vec3 place = three(&e->scene.places, pixel), normal = three(&e->scene.normals, pixel);
    const float *without = e->without.data + 3 * pixel, *with = e->with.data + 3 * pixel;
    const float *lone = e->lone->data + 3 * pixel;
    double part[3] = {1.0, 1.0, 1.0};
    if (holds(&e->scene, pixel) && keeps_lamps(e)) {
        const struct lit_by lit = lamps_put(e, pixel);
        quotient(part, lone, &lit, without, with);
    } else if (holds(&e->scene, pixel) &&
               (memcmp(without, with, 3 * sizeof *with) || is_in_shadow(e, place, normal, 1, 0))) {
        const struct lit_by lit = lamps_at(e, place, normal, 1, 0);
        quotient(part, lone, &lit, without, with);
    }
    for (size_t c = 0; c < 3; c++)
        e->lit->data[3 * pixel + c] += (float)part[c] * lone[c];
}

// What the objects have gathered is part of what a screen shows to the scene.
static void light_objects(struct exchange *e, int x, int y)
{
    const size_t pixel = 3 * pixel_of(e, x, y);
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
        status = over_pixels(e, rays, gather_at_objects);
    if (!status && e->spacing > 1)
        status = over_pixels(e, rays, fill_objects);
    if (!status)
        status = smooth_objects(e);
    return status ? status : over_pixels(e, 1, light_objects);
}

static relume_status gather(struct exchange *e)
{
    begin_world(e);
    const int lamps = e->lighting.light_samples + 1, rays = e->world.samples * 4;
    const int few = rays / (e->spacing * e->spacing) + 1;
    relume_status status = e->transport->screen ? over_pixels(e, lamps, show) : RELUME_OK;
    if (!status && e->transport->begin)
        status = e->transport->begin(&e->world, e->params.log);
    if (!status && (e->reflected || e->transport->screen))
        status = gather_at_all_objects(e, few);
    if (!status)
        status = over_pixels(e, few, gather_at_scene);
    if (!status && e->spacing > 1)
        status = over_pixels(e, few, fill_scene);
    if (!status)
        status = smooth_scene(e);
    if (e->transport->end)
        e->transport->end(&e->world);
    return status ? status : over_pixels(e, lamps, light_scene);
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
