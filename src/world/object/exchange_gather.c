// exchange_gather.c - light that the pixels of a scene and of the objects in it gather, or take
// from those around them
#include "world/object/exchange.h"

#include "core/math/random.h"

static uint64_t key_of(const struct exchange *e, int x, int y)
{
    const int n = e->transport->pattern;
    return n > 1 ? (uint64_t)(x % n + n * (y % n)) : random_mix(exchange_pixel(e, x, y));
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
    if (a->answer)
        for (int c = 0; c < 3; c++)
            rgb[c] = a->answer[c] * a->with[c];
    else
        objects_return(rgb, s->e->o, s->point, s->eye, a);
    add(s->returned, 1.0, rgb);
}

static void answer_of(float rgb[3], const void *context, vec3 towards)
{
    const struct at_objects *s = context;
    const struct arrival a = {.towards = towards, .share = 1.0, .with = {1.0f, 1.0f, 1.0f}};
    objects_return(rgb, s->e->o, s->point, s->eye, &a);
}

static vec3 mirrored_at(const struct surface_point *point, vec3 eye)
{
    const vec3 to = vec3_unit(vec3_sub(eye, point->position)), n = point->normal;
    return vec3_along(vec3_scale(to, -1.0), n, 2.0 * vec3_dot(n, to));
}

static void gather_scene(struct exchange *e, int x, int y)
{
    const size_t pixel = exchange_pixel(e, x, y);
    const vec3 place = places_at(&e->scene.places, pixel),
               normal = places_at(&e->scene.normals, pixel);
    struct at_scene at = {e->without.data + 3 * pixel, e->with.data + 3 * pixel};
    const struct site site = {.position = place,
                              .normal = normal,
                              .start =
                                  e->scenery ? scenery_leave(e->scenery, place, normal) : place,
                              .key = key_of(e, x, y)};
    e->transport->gather(&e->world, &site, arrive_at_scene, &at);
}

void exchange_gather_at(struct exchange *e, const struct surface_point *point, vec3 eye,
                        uint64_t key, float white[3], float returned[3])
{
    struct at_objects at = {e, point, eye, white, returned};
    if (translucent_return(returned, &e->lighting, point, eye)) {
        white[0] = white[1] = white[2] = 1.0f;  // has been smoothed below its surface
        return;
    }
    const struct site site = {.position = point->position,
                              .normal = point->normal,
                              .start = point_leave(point),
                              .key = key,
                              .answer = exchange_shines(e, point->part) ? answer_of : NULL,
                              .answers = &at,
                              .mirrored = mirrored_at(point, eye)};
    e->transport->gather(&e->world, &site, arrive_at_objects, &at);
}

// Of a mirror, what is seen in it.
static void gather_objects(struct exchange *e, int x, int y, const struct surface_point *point)
{
    const size_t pixel = exchange_pixel(e, x, y);
    const double middle[2] = {0.5, 0.5};
    struct surface_point seen = *point;
    struct mirrored mirrored = {.part = {1.0f, 1.0f, 1.0f}};
    vec3 eye = exchange_ray(e, x, y, middle).origin;
    float *returned = e->returned.data + 3 * pixel;
    if (objects_mirror_at(e->o, point)) {
        mirror_follow(&mirrored, e->o, point, eye, &e->lighting);
        if (!mirrored.meets)
            return;
        seen = mirrored.point;
        eye = mirrored.from;
    }
    exchange_gather_at(e, &seen, eye, key_of(e, x, y), e->white.data + 3 * pixel, returned);
    for (int c = 0; c < 3; c++)
        returned[c] *= mirrored.part[c];
}

bool exchange_keeps_lamps(const struct exchange *e)
{
    return e->spacing > 1 && e->lighting.light_samples > 1;
}

static void gather_lamps(struct exchange *e, size_t pixel)
{
    exchange_put_lamps(e, pixel, places_at(&e->scene.places, pixel),
                       places_at(&e->scene.normals, pixel));
}

void exchange_gather_scene(struct exchange *e, int x, int y)
{
    const size_t pixel = exchange_pixel(e, x, y);
    if (!transport_gathers(e->spacing, x, y) || !layer_holds(&e->scene, pixel))
        return;
    gather_scene(e, x, y);
    if (exchange_keeps_lamps(e))
        gather_lamps(e, pixel);
}

static void look_ahead(float rgb[3], const struct exchange *e, const struct surface_point *point)
{
    const struct arrival a = {.towards = point->normal, .share = 1.0, .with = {1.0f, 1.0f, 1.0f}};
    objects_return(rgb, e->o, point, e->eye, &a);
}

static void put_share(const struct exchange *e, size_t pixel, const struct surface_point *point)
{
    struct lighting lighting = e->lighting;
    if (!e->share)
        return;
    if (e->befores)
        lighting.scenery = e->before, lighting.sceneries = e->befores;
    float *share = e->share->data + 3 * pixel;
    if (e->spacing > 1)
        share_of_sky(share, e->o, point, &lighting, 0);
    else
        share_in_pattern(share, e->o, point, &lighting, 0, (int)(pixel % (size_t)e->share->width),
                         (int)(pixel / (size_t)e->share->width));
}

void exchange_gather_objects(struct exchange *e, int x, int y)
{
    const size_t pixel = exchange_pixel(e, x, y);
    struct surface_point point;
    if (e->share)
        places_put(e->share, pixel, vec3_of(NAN, NAN, NAN));
    if (!transport_gathers(e->spacing, x, y) || !layer_holds(&e->objects, pixel) ||
        !exchange_objects_at(&point, e, x, y))
        return;
    gather_objects(e, x, y, &point);
    put_share(e, pixel, &point);
    if (e->spacing > 1)
        look_ahead(e->ahead.data + 3 * pixel, e, &point);
}

// ---------------------------------------------------------------- between pixels that gather

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

void exchange_fill_scene(struct exchange *e, int x, int y)
{
    const size_t pixel = exchange_pixel(e, x, y);
    struct between_pixels b;
    if (transport_gathers(e->spacing, x, y) || !layer_holds(&e->scene, pixel))
        return;
    transport_between(&b, e->spacing, x, y, &e->scene.places, &e->scene.normals, e->eye);
    if (!b.count || differ(&b, &e->with, &e->without)) {
        gather_scene(e, x, y);
    } else {
        between(e->without.data + 3 * pixel, &b, &e->without);
        between(e->with.data + 3 * pixel, &b, &e->with);
    }
    if (exchange_keeps_lamps(e))
        fill_lamps(e, pixel, &b);
}

// Objects keep their texture: what is taken from the pixels around is what they return over what
// they do of light from straight ahead.
void exchange_fill_objects(struct exchange *e, int x, int y)
{
    const size_t pixel = exchange_pixel(e, x, y);
    struct surface_point point;
    struct between_pixels b;
    float own[3], ahead[3], *returned = e->returned.data + 3 * pixel;
    if (transport_gathers(e->spacing, x, y) || !layer_holds(&e->objects, pixel) ||
        !exchange_objects_at(&point, e, x, y))
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
