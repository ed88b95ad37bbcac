// exchange_further.c - the objects from further cameras (Ritschel, Grosch, Seidel 2009,
// "Approximating dynamic global illumination in image space": additional cameras): what the eye
// does not see of them hides and sends light, too
//
// Cameras lie all around the objects, as far apart from each other and from the eye as a spiral
// over the sphere has them, and see them along parallel rays, so that each picture holds the ball
// about them. The captured scene is in none of them: rays meet it wherever it is.
#include "world/object/exchange.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/random.h"
#include "world/transport/points.h"

enum { SIDE = 64 };  // pixels

struct picture {
    struct relume_image places, normals, shown, returned;
    float *behind;  // [pixels]
};
struct further_pictures {
    struct further *further;  // [cameras]
    struct picture *picture;  // [cameras]
    int cameras;
};

// Camera `i` of n, by the direction to the eye, which is number -1.
static vec3 direction_to(int i, int n, vec3 eye)
{
    const double GOLDEN = M_PI * (3.0 - sqrt(5.0));
    const double up = 1.0 - 2.0 * (i + 1) / n, across = sqrt(fmax(1.0 - up * up, 0.0));
    const vec3 any = fabs(eye.y) < 0.9 ? vec3_of(0, 1, 0) : vec3_of(1, 0, 0);
    const vec3 x = vec3_unit(vec3_cross(any, eye)), y = vec3_cross(eye, x);
    return vec3_along(vec3_along(vec3_scale(eye, up), x, across * cos(GOLDEN * i)), y,
                      across * sin(GOLDEN * i));
}

static struct ray ray_of(const struct further *f, int x, int y)
{
    const double u = 2.0 * (x + 0.5) / SIDE - 1.0, v = 2.0 * (y + 0.5) / SIDE - 1.0;
    const vec3 at = vec3_along(vec3_along(f->middle, f->x, u * f->half), f->y, v * f->half);
    return (struct ray){vec3_along(at, f->z, -2.0 * f->half), f->z};
}

static float depth_behind(const struct exchange *e, const struct further *f, const struct ray *ray,
                          const struct surface_point *front)
{
    const double STEP = 1e-4;  // of what the camera sees
    const vec3 inside = vec3_along(front->position, ray->direction, STEP * f->half);
    struct surface_point back;
    return (float)(vec3_dot(vec3_sub(inside, f->middle), f->z) +
                   (objects_hit(&back, e->o, inside, ray->direction) ? back.distance : 0.0));
}

// From where a place that shines is seen, as often as the cosine is.
static vec3 eye_before(const struct surface_point *point, double u, double v)
{
    const struct point at = {.normal = point->normal};
    return vec3_add(point->position, points_direction(&at, u, v));
}

// The camera may see a highlight that others do not: what shines sends its mean.
static void shade(float rgb[3], const struct exchange *e, const struct surface_point *point,
                  const struct ray *ray, uint64_t key)
{
    enum { DIRECTIONS = 16 };
    const double GOLDEN = 0.6180339887498949;
    if (!exchange_shines(e, point->part)) {
        objects_shade(rgb, e->o, point, ray->origin, &e->lighting);
        return;
    }
    struct random r = random_stream(9, key, 0);
    const double first = random_next(&r);
    for (int i = 0; i < DIRECTIONS; i++) {
        float sent[3];
        objects_shade(sent, e->o, point,
                      eye_before(point, (i + random_next(&r)) / DIRECTIONS, first + GOLDEN * i),
                      &e->lighting);
        for (int c = 0; c < 3; c++)
            rgb[c] += sent[c] / DIRECTIONS;
    }
}

struct looking {
    struct exchange *e;
    int camera;
};

static void look(void *context, size_t row, int worker)
{
    (void)worker;
    const struct looking *l = context;
    const struct exchange *e = l->e;
    const struct further *f = &e->further->further[l->camera];
    struct picture *p = &e->further->picture[l->camera];
    for (int x = 0; x < SIDE; x++) {
        const size_t pixel = row * SIDE + (size_t)x;
        const struct ray ray = ray_of(f, x, (int)row);
        struct surface_point point;
        places_put(&p->places, pixel, vec3_of(NAN, NAN, NAN));
        if (!objects_hit(&point, e->o, ray.origin, ray.direction))
            continue;
        places_put(&p->places, pixel, point.position);
        places_put(&p->normals, pixel, point.normal);
        p->behind[pixel] = depth_behind(e, f, &ray, &point);
        shade(p->shown.data + 3 * pixel, e, &point, &ray, pixel);
    }
}

static void gather(void *context, size_t row, int worker)
{
    (void)worker;
    const struct looking *l = context;
    struct exchange *e = l->e;
    const struct further *f = &e->further->further[l->camera];
    struct picture *p = &e->further->picture[l->camera];
    const int pattern = e->transport->pattern;
    for (int x = 0; x < SIDE; x++) {
        const size_t pixel = row * SIDE + (size_t)x;
        const struct ray ray = ray_of(f, x, (int)row);
        struct surface_point point;
        float white[3] = {0.0f, 0.0f, 0.0f};
        if (isnan(p->places.data[3 * pixel]) ||
            !objects_hit(&point, e->o, ray.origin, ray.direction) ||
            objects_mirror_at(e->o, &point))
            continue;
        const int key = x % pattern + pattern * ((int)row % pattern);
        struct random r = random_stream(10, pixel, 0);
        const double u = random_next(&r);
        const vec3 eye =
            exchange_shines(e, point.part) ? eye_before(&point, u, random_next(&r)) : ray.origin;
        exchange_gather_at(e, &point, eye, (uint64_t)key, white, p->returned.data + 3 * pixel);
    }
}

static relume_status make_picture(struct picture *p)
{
    struct relume_image *const images[] = {&p->places, &p->normals, &p->shown, &p->returned};
    relume_status status = RELUME_OK;
    for (size_t i = 0; i < sizeof images / sizeof *images && !status; i++)
        status = relume_image_create(images[i], SIDE, SIDE, 3);
    p->behind = mem_array((size_t)SIDE * SIDE, sizeof *p->behind);
    return status || p->behind ? status : RELUME_ENOMEM;
}

typedef void look_at_row(void *context, size_t row, int worker);

static void over_rows(struct exchange *e, look_at_row *work)
{
    for (int i = 0; i < e->further->cameras; i++)
        thread_for(e->params.threads, SIDE, work, &(struct looking){e, i});
}

relume_status exchange_further_create(struct exchange *e)
{
    const struct relume_objects_info *info = relume_objects_info(e->o);
    const vec3 middle = vec3_scale(vec3_add(info->min, info->max), 0.5);
    const vec3 to = vec3_sub(e->eye, middle);
    const vec3 eye = vec3_length(to) > 0.0 ? vec3_unit(to) : vec3_of(0, 0, 1);
    struct further_pictures *all = e->further = mem_zeroed(1, sizeof *all);
    if (!all)
        return RELUME_ENOMEM;
    all->further = mem_zeroed((size_t)e->cameras, sizeof *all->further);
    all->picture = mem_zeroed((size_t)e->cameras, sizeof *all->picture);
    if (!all->further || !all->picture)
        return RELUME_ENOMEM;
    for (; all->cameras < e->cameras; all->cameras++) {
        struct picture *p = &all->picture[all->cameras];
        const vec3 z = vec3_scale(direction_to(all->cameras, e->cameras, eye), -1.0);
        const vec3 any = fabs(z.x) < 0.7 ? vec3_of(1, 0, 0) : vec3_of(0, 1, 0);
        const vec3 x = vec3_unit(vec3_cross(any, z));
        const relume_status status = make_picture(p);
        all->further[all->cameras] =
            (struct further){.middle = middle,
                             .x = x,
                             .y = vec3_cross(z, x),
                             .z = z,
                             .half = e->world.radius,
                             .screen = {&p->places, &p->normals, &p->shown, p->behind}};
        if (status)
            return status;
    }
    over_rows(e, look);
    e->world.further = all->further;
    e->world.furthers = all->cameras;
    return RELUME_OK;
}

void exchange_further_gather(struct exchange *e)
{
    if (e->further && e->world.bounces > 1)
        over_rows(e, gather);
}

void exchange_further_show(struct exchange *e)
{
    for (int i = 0; e->further && i < e->further->cameras; i++)
        for (size_t k = 0; k < (size_t)3 * SIDE * SIDE; k++)
            e->further->picture[i].shown.data[k] += e->further->picture[i].returned.data[k];
}

void exchange_further_destroy(struct exchange *e)
{
    struct further_pictures *all = e->further;
    e->further = NULL;
    e->world.further = NULL, e->world.furthers = 0;
    for (int i = 0; all && all->picture && i < e->cameras; i++) {
        struct picture *p = &all->picture[i];
        relume_image_destroy(&p->places);
        relume_image_destroy(&p->normals);
        relume_image_destroy(&p->shown);
        relume_image_destroy(&p->returned);
        mem_free(p->behind);
    }
    if (all) {
        mem_free(all->further);
        mem_free(all->picture);
    }
    mem_free(all);
}
