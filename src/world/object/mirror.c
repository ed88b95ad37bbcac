// mirror.c - what mirrors show of what is around them
//
// In a panorama a reflected ray is followed until it is farther from the panorama's eye than what
// the panorama shows in that direction (distance impostors: Szirmay-Kalos, Aszodi, Lazanyi and
// Premecz 2005, "Approximate ray-tracing on the GPU with distance impostors"), in steps of equal
// angle to the eye or so. A ray that passes behind something goes on: what is there the panorama
// has not seen. One that hits nothing ends in the far distance. Where light goes between objects
// and a scene, mirrors show objects, too.
#include "relight/light/environment.h"
#include "relight/view/view.h"
#include "world/object/drawn_objects.h"
#include "world/object/object.h"
#include "world/reflect/reflection.h"

#include <relume/light.h>
#include <relume/relight/view.h>

bool objects_have_mirrors(const relume_objects *o)
{
    for (int i = 0; i < o->info.parts; i++)
        if (o->material[o->part[i].material].mirror)
            return true;
    return false;
}

bool surround_lacks(const struct surround *s, const relume_objects *o)
{
    bool environment = false;
    for (int i = 0; i < s->lights; i++)
        environment |= s->light[i].kind == RELUME_LIGHT_ENVIRONMENT;
    return !s->geometry && !environment && objects_have_mirrors(o);
}

// ---------------------------------------------------------------- panoramas

// How far the panorama's eye sees in a direction.
static double depth_at(const struct surround *s, vec3 direction)
{
    float p[3];
    if (!relume_panorama_sample(p, s->geometry, &s->places, direction,
                                &(struct relume_view_params){.filter = RELUME_FILTER_NEAREST}))
        return INFINITY;
    const vec3 at = vec3_of((double)p[0], (double)p[1], (double)p[2]);
    const double depth = vec3_length(vec3_sub(at, s->geometry->center));
    return isnan(depth) ? INFINITY : depth;
}

// A ray once it has come a part of its way, 1 being infinitely far, as the panorama's eye sees it.
struct progress {
    double part, excess;  // how much farther off it is than what is seen there
    double depth;
    vec3 direction;
};

static struct progress follow(const struct surround *s, vec3 from, vec3 along, double part)
{
    const vec3 at =
        vec3_add(vec3_scale(from, 1.0 - part), vec3_scale(along, part * vec3_length(from)));
    const double length = vec3_length(at);
    const vec3 d = length > 0.0 && part < 1.0 ? vec3_scale(at, 1.0 / length) : along;
    const double depth = depth_at(s, d), distance = part < 1.0 ? length / (1.0 - part) : INFINITY;
    const double excess = depth < INFINITY ? distance - depth : -INFINITY;
    return (struct progress){part, excess, depth, d};
}

// Between a place before and one behind what is seen; true where the ray goes through it, and not
// past its border.
static bool close_in(struct progress *hit, const struct surround *s, vec3 from, vec3 along,
                     struct progress before, struct progress behind)
{
    enum { HALVINGS = 12 };
    const double THROUGH = 0.1;  // of its distance: two texels of a slope, no step of depth
    for (int i = 0; i < HALVINGS; i++) {
        const struct progress middle = follow(s, from, along, 0.5 * (before.part + behind.part));
        *(middle.excess > 0.0 ? &behind : &before) = middle;
    }
    *hit = behind;
    return behind.excess <= THROUGH * behind.depth;
}

static vec3 seen_along(const struct surround *s, vec3 place, vec3 along)
{
    enum { STEPS = 32 };
    const vec3 from = vec3_sub(place, s->geometry->center);
    struct progress before = follow(s, from, along, 0.0), hit;
    for (int i = 1; i <= STEPS; i++) {
        const struct progress now = follow(s, from, along, (double)i / STEPS);
        if (now.excess > 0.0 && before.excess <= 0.0 && close_in(&hit, s, from, along, before, now))
            return hit.direction;
        before = now;
    }
    return along;
}

bool relume_objects_reflected_place(vec3 *out, const struct relume_geometry *panorama,
                                    const struct relume_image *places, vec3 place, vec3 direction)
{
    const struct surround s = {.geometry = panorama, .places = *places};
    const vec3 seen = seen_along(&s, place, direction);
    const double depth = depth_at(&s, seen);
    *out = vec3_along(panorama->center, seen, depth);
    return depth < INFINITY;
}

static void panorama_value(float rgb[3], const struct surround *s, vec3 place, vec3 direction)
{
    const struct relume_view_params params = {.filter = s->filter};
    const vec3 seen = seen_along(s, place, direction);
    if (!relume_panorama_sample(rgb, s->geometry, &s->panorama, seen, &params))
        rgb[0] = rgb[1] = rgb[2] = 0.0f;
}

// ---------------------------------------------------------------- environments

// The map is laid out as a spherical panorama.
static void add_environment(float rgb[3], const struct relume_light *light, vec3 direction)
{
    static const struct relume_geometry sphere = {.projection = RELUME_SPHERICAL};
    const vec3 d = relume_environment_turn(direction, -light->rotate_deg);
    float value[3];
    if (!relume_panorama_sample(value, &sphere, relume_environment_map(light->environment), d,
                                NULL))
        return;
    for (int c = 0; c < 3; c++)
        rgb[c] += light->rgb[c] * value[c];
}

static void scenery_value(float rgb[3], const struct scenery *scenery, vec3 place, vec3 direction)
{
    struct scenery_hit hit;
    (void)scenery_meet(&hit, scenery, scenery_leave(scenery, place, direction), direction);
    for (int c = 0; c < 3; c++)
        rgb[c] = hit.sent[c];
}

void surround_value(float rgb[3], const struct surround *s, vec3 place, vec3 direction)
{
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (s->scenery) {
        scenery_value(rgb, s->scenery, place, direction);
        return;
    }
    if (s->geometry) {
        panorama_value(rgb, s, place, direction);
        return;
    }
    for (int i = 0; i < s->lights; i++)
        if (s->light[i].kind == RELUME_LIGHT_ENVIRONMENT)
            add_environment(rgb, &s->light[i], direction);
}

// ---------------------------------------------------------------- mirrors

static void find_reflection(struct relume_object_reflection *out, const relume_objects *o,
                            const struct surface_point *p, vec3 eye)
{
    const struct relume_object_part *part = &o->part[p->part];
    const relume_reflection *edit = o->reflection[part->object];
    const uint32_t *v = o->triangles[p->triangle];
    *out = (struct relume_object_reflection){
        .place = {p->position, {v[0], v[1], v[2]}, {p->corner[0], p->corner[1], p->corner[2]}},
        .object = part->object,
        .part = p->part,
        .normal = p->normal,
        .original = relume_reflection_original(edit, p->position, p->normal, eye),
    };
    out->edited = edit ? relume_reflection_turn(edit, &out->place, out->original) : out->original;
}

bool relume_objects_reflect(struct relume_object_reflection *out, const relume_objects *o, vec3 eye,
                            vec3 direction)
{
    const double MOST = 1e18;  // squares of single numbers stay finite
    const double length = vec3_length(direction);
    struct surface_point p;
    if (!(length > 0.0 && length < MOST && vec3_length(eye) < MOST) ||
        !objects_hit(&p, o, eye, vec3_unit(direction)))
        return false;
    find_reflection(out, o, &p, eye);
    return true;
}

bool objects_mirror_at(const relume_objects *o, const struct surface_point *p)
{
    return o->material[o->part[p->part].material].mirror;
}

static void reflect_part(float part[3], const relume_objects *o, const struct surface_point *p,
                         vec3 eye)
{
    const struct relume_object_material *m = &o->material[o->part[p->part].material];
    const double cosine = vec3_dot(p->normal, vec3_unit(vec3_sub(eye, p->position)));
    const double grazing = 1.0 - fmin(fmax(cosine, 0.0), 1.0);
    const float rest = (float)(grazing * grazing * grazing * grazing * grazing);
    for (int c = 0; c < 3; c++)
        part[c] *= m->reflectance[c] + (1.0f - m->reflectance[c]) * rest;
}

// Whether a ray off a mirror meets objects before the scene. Edited ones may go into the surface:
// they look up what is around.
static bool meets_objects(struct surface_point *next, const relume_objects *o,
                          const struct surface_point *p, vec3 along, const struct lighting *l)
{
    if (!(vec3_dot(along, p->geometric) > 0.0) || !objects_hit(next, o, point_leave(p), along))
        return false;
    for (int i = 0; i < l->sceneries; i++) {
        struct scenery_hit scene;
        const vec3 start = scenery_leave(l->scenery[i], p->position, p->geometric);
        if (scenery_meet(&scene, l->scenery[i], start, along) && scene.distance < next->distance)
            return false;
    }
    return true;
}

void mirror_follow(struct mirrored *out, const relume_objects *o, const struct surface_point *point,
                   vec3 eye, const struct lighting *l)
{
    enum { MOST = 6 };  // mirrors
    struct surface_point at = *point;
    *out = (struct mirrored){.part = {1.0f, 1.0f, 1.0f}};
    for (int i = 0; i < MOST && !out->meets; i++) {
        struct relume_object_reflection reflection;
        reflect_part(out->part, o, &at, eye);
        find_reflection(&reflection, o, &at, eye);
        out->from = eye = at.position;
        out->direction = reflection.edited;
        if (!l->sceneries || !meets_objects(&out->point, o, &at, out->direction, l))
            return;
        out->meets = !objects_mirror_at(o, &out->point);
        at = out->point;
    }
}

void mirror_shade(float rgb[3], const relume_objects *o, const struct surface_point *p, vec3 eye,
                  const struct lighting *l)
{
    struct mirrored m;
    struct lighting there = *l;
    there.shares = NULL;  // they are those of the mirror
    mirror_follow(&m, o, p, eye, l);
    if (m.meets)
        objects_shade(rgb, o, &m.point, m.from, &there);
    else
        surround_value(rgb, &l->surround, m.from, m.direction);
    for (int c = 0; c < 3; c++)
        rgb[c] *= m.part[c];
}
