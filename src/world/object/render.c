// render.c - the objects ray traced: the reference
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "material/surface/texels.h"
#include "world/object/drawn_objects.h"
#include "world/object/levels.h"
#include "world/object/skin.h"

#include <string.h>

// Towards the eye a surface is never seen from below, but where normals are interpolated the frame
// may say so; these take the lowest view.
static const double LOWEST = 1e-3;

// The frame between the corners: the normal, the tangent across it, and the other as the corners'
// handedness says (one for all three).
static void interpolate(struct surface_point *p, const struct relume_mesh_vertex *v[3],
                        const double weight[3])
{
    vec3 normal = {0, 0, 0}, tangent = {0, 0, 0};
    p->position = vec3_of(0, 0, 0);
    p->s = p->t = 0.0;
    for (int k = 0; k < 3; k++) {
        p->position = vec3_along(p->position, vec3_floats(v[k]->position), weight[k]);
        normal = vec3_along(normal, vec3_floats(v[k]->normal), weight[k]);
        tangent = vec3_along(tangent, vec3_floats(v[k]->tangent), weight[k]);
        p->s += weight[k] * (double)v[k]->texture[0];
        p->t += weight[k] * (double)v[k]->texture[1];
    }
    p->normal = vec3_length(normal) > 0.0 ? vec3_unit(normal) : p->geometric;
    tangent = vec3_sub(tangent, vec3_scale(p->normal, vec3_dot(tangent, p->normal)));
    const vec3 any = fabs(p->normal.x) < 0.7 ? vec3_of(1, 0, 0) : vec3_of(0, 1, 0);
    p->tangent = vec3_unit(vec3_length(tangent) > 1e-9 ? tangent : vec3_cross(any, p->normal));
    p->bitangent = vec3_scale(vec3_cross(p->normal, p->tangent), (double)v[0]->tangent[3]);
}

// Onto the surface that the corners' normals mean, where it stands over the flat triangle: flat
// ones of a smooth mesh would shade each other along the border of the light (Hanika, "Hacking the
// Shadow Terminator", 2021).
static vec3 lift(const struct surface_point *p, const struct relume_mesh_vertex *v[3],
                 const double weight[3], double side)
{
    vec3 lifted = p->position;
    for (int k = 0; k < 3; k++) {
        const vec3 n = vec3_scale(vec3_floats(v[k]->normal), side);
        const double under = vec3_dot(vec3_sub(p->position, vec3_floats(v[k]->position)), n);
        if (under < 0.0)
            lifted = vec3_sub(lifted, vec3_scale(n, under * weight[k]));
    }
    return lifted;
}

void objects_point(struct surface_point *out, const relume_objects *o, const struct trace_hit *hit,
                   vec3 direction)
{
    const struct relume_mesh_vertex *v[3];
    for (int k = 0; k < 3; k++)
        v[k] = &o->vertices[o->triangles[hit->triangle][k]];
    const double u = (double)hit->u, w = (double)hit->v;
    const double weight[3] = {1.0 - u - w, u, w};
    const vec3 first = vec3_floats(v[0]->position);
    out->geometric = vec3_unit(vec3_cross(vec3_sub(vec3_floats(v[1]->position), first),
                                          vec3_sub(vec3_floats(v[2]->position), first)));
    out->distance = (double)hit->distance;
    out->triangle = hit->triangle;
    memcpy(out->corner, weight, sizeof weight);
    memset(out->right, 0, sizeof out->right);
    memset(out->down, 0, sizeof out->down);
    out->part = (int)o->mesh.triangles[hit->triangle].material;
    interpolate(out, v, weight);
    // from behind: the same sample seen through, its normal on this side
    const double side = hit->side                                   ? hit->side
                        : vec3_dot(out->geometric, direction) > 0.0 ? -1.0
                                                                    : 1.0;
    out->geometric = vec3_scale(out->geometric, side);
    out->normal = vec3_scale(out->normal, side);
    out->lifted = lift(out, v, weight, side);
}

vec3 point_leave(const struct surface_point *p)
{
    float at[3], off[3], from[3];
    vec3_store(at, p->lifted);
    vec3_store(off, p->geometric);
    trace_leave(at, off, from);
    return vec3_floats(from);
}

// Whether a ray comes near the objects at all: to the ball about them.
static bool may_meet(const relume_objects *o, vec3 origin, vec3 direction)
{
    const double ROUNDING = 1.001;
    const vec3 across = vec3_sub(o->info.max, o->info.min);
    const vec3 to = vec3_sub(vec3_scale(vec3_add(o->info.max, o->info.min), 0.5), origin);
    const double square = 0.25 * ROUNDING * vec3_dot(across, across), away = vec3_dot(to, to);
    const double along = vec3_dot(to, direction);
    return away <= square || (along > 0.0 && away - along * along <= square);
}

bool objects_hit(struct surface_point *out, const relume_objects *o, vec3 origin, vec3 direction)
{
    float from[3], along[3];
    struct trace_hit hit;
    vec3_store(from, origin);
    vec3_store(along, direction);
    if (!may_meet(o, origin, direction) || !trace_closest(o->tracer, from, along, &hit))
        return false;
    objects_point(out, o, &hit, direction);
    return true;
}

// The object that a ray meets first, and whether it meets that an odd number of times.
static bool leaves_more_often(int *object, const relume_objects *o, vec3 from, vec3 direction)
{
    enum { MOST = 256 };
    const double STEP = 1e-6;
    struct surface_point at;
    bool odd = false;
    *object = -1;
    for (int i = 0; i < MOST && objects_hit(&at, o, from, direction); i++) {
        const int met = o->part[at.part].object;
        *object = i ? *object : met;
        odd ^= met == *object;
        from = vec3_along(at.position, direction, STEP * (at.distance + vec3_length(at.position)));
    }
    return odd;
}

int objects_around(const relume_objects *o, vec3 place)
{
    static const vec3 ways[] = {{0.27, 0.91, 0.32}, {-0.88, 0.11, 0.46}, {0.51, -0.43, -0.74}};
    int first = -1;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        int object;
        if (!leaves_more_often(&object, o, place, vec3_unit(ways[i])) || (i && object != first))
            return -1;
        first = object;
    }
    return first;
}

void objects_say_around(bool *said, const relume_objects *o, vec3 eye, const struct relume_log *log)
{
    const int object = objects_around(o, eye);
    if (object >= 0 && !*said)
        log_line(log, RELUME_NOTE,
                 "the eye is within object %d: what it shows is the inside of that, which lamps do "
                 "not reach",
                 object);
    *said = object >= 0;
}

// The step over the plane of the surface that a ray beside makes.
static vec3 step_over(const struct surface_point *p, const struct ray *ray,
                      const struct ray *beside)
{
    const vec3 turned = vec3_sub(beside->direction, ray->direction);
    const vec3 across = vec3_along(vec3_sub(beside->origin, ray->origin), turned, p->distance);
    const double facing = fmin(vec3_dot(ray->direction, p->geometric), -1e-6);
    const double further = -vec3_dot(across, p->geometric) / facing;
    return vec3_along(across, ray->direction, further);
}

// A step over the triangle's plane in texture coordinates.
static void step_in_texture(double out[2], const relume_objects *o, size_t triangle, vec3 step)
{
    const struct relume_mesh_vertex *v[3];
    for (int k = 0; k < 3; k++)
        v[k] = &o->vertices[o->triangles[triangle][k]];
    const vec3 a = vec3_sub(vec3_floats(v[1]->position), vec3_floats(v[0]->position));
    const vec3 b = vec3_sub(vec3_floats(v[2]->position), vec3_floats(v[0]->position));
    const double aa = vec3_dot(a, a), bb = vec3_dot(b, b), ab = vec3_dot(a, b);
    const double sa = vec3_dot(step, a), sb = vec3_dot(step, b), area = aa * bb - ab * ab;
    const double along_a = area > 0.0 ? (sa * bb - sb * ab) / area : 0.0;
    const double along_b = area > 0.0 ? (sb * aa - sa * ab) / area : 0.0;
    for (int i = 0; i < 2; i++)
        out[i] = along_a * (double)(v[1]->texture[i] - v[0]->texture[i]) +
                 along_b * (double)(v[2]->texture[i] - v[0]->texture[i]);
}

void objects_spread(struct surface_point *p, const relume_objects *o, const struct ray *ray,
                    const struct ray *right, const struct ray *below)
{
    step_in_texture(p->right, o, p->triangle, step_over(p, ray, right));
    step_in_texture(p->down, o, p->triangle, step_over(p, ray, below));
}

static bool is_blocked(struct trace_hit *hit, const relume_objects *o, vec3 point, vec3 normal,
                       vec3 towards, double distance)
{
    float at[3], off[3], from[3], along[3];
    if (!may_meet(o, point, towards))
        return false;
    vec3_store(at, point);
    vec3_store(off, normal);
    vec3_store(along, towards);
    trace_leave(at, off, from);
    return trace_closest(o->tracer, from, along, hit) && (double)hit->distance < distance;
}

bool objects_reached(const relume_objects *o, vec3 point, vec3 normal, vec3 towards,
                     double distance)
{
    struct trace_hit hit;
    return !is_blocked(&hit, o, point, normal, towards, distance);
}

static double longest_edge(const relume_objects *o, uint32_t triangle)
{
    double most = 0.0;
    for (int k = 0; k < 3; k++) {
        const float *a = o->vertices[o->triangles[triangle][k]].position,
                    *b = o->vertices[o->triangles[triangle][(k + 1) % 3]].position;
        most = fmax(most, vec3_length(vec3_sub(vec3_floats(a), vec3_floats(b))));
    }
    return most;
}

// A coarse level has folds that would throw dark slivers on the triangles beside them: there light
// counts that passes a part of the level's error above. All of the error let twice as much light
// into shadows that begin there, and took hardly more slivers away.
#define FOLD 0.25
static bool is_past_folds(const relume_objects *o, const struct surface_point *p, vec3 towards,
                          double distance)
{
    const double fold = FOLD * (double)o->fold[p->part];
    struct trace_hit hit;
    if (!(fold > 0.0) || !is_blocked(&hit, o, p->lifted, p->geometric, towards, distance))
        return false;
    return (double)hit.distance < longest_edge(o, p->triangle) + longest_edge(o, hit.triangle) &&
           objects_reached(o, vec3_along(p->lifted, p->normal, fold), p->geometric, towards,
                           distance);
}

static vec3 local(const struct surface_point *p, vec3 d)
{
    return vec3_of(vec3_dot(d, p->tangent), vec3_dot(d, p->bitangent), vec3_dot(d, p->normal));
}

// Colours of the corners, where the mesh has some.
static void tint(float rgb[3], const relume_objects *o, const struct surface_point *p)
{
    const uint32_t *v = o->triangles[p->triangle];
    for (int c = 0; c < 3; c++) {
        double part = 0.0;
        for (int k = 0; k < 3; k++)
            part += p->corner[k] * (double)o->tint[v[k]][c];
        rgb[c] *= (float)part;
    }
}

void objects_ask(float rgb[3], const relume_objects *o, const struct surface_point *p,
                 const struct relume_btf_ray *ray)
{
    const struct relume_object_part *part = &o->part[p->part];
    const struct relume_object_material *m = &o->material[part->material];
    const double x = p->s * m->width, y = p->t * m->height;
    const struct relume_btf_footprint pixel = {x,
                                               y,
                                               {p->right[0] * m->width, p->right[1] * m->height},
                                               {p->down[0] * m->width, p->down[1] * m->height}};
    if (part->bilinear)
        relume_btf_surface_filter(m->surface, &pixel, ray, rgb);
    else
        relume_btf_surface_evaluate(m->surface, floor(x) + 0.5, floor(y) + 0.5, 0.0, ray, rgb);
    if (o->tint)
        tint(rgb, o, p);
}

bool objects_lit(const relume_objects *o, const struct surface_point *p, const struct lighting *l,
                 vec3 towards, double distance)
{
    if (l->no_shadows)
        return true;
    bool is = objects_reached(o, p->lifted, p->geometric, towards, distance) ||
              (o->fold && is_past_folds(o, p, towards, distance));
    for (int i = 0; i < l->sceneries && is; i++)
        is = scenery_reached(l->scenery[i], scenery_leave(l->scenery[i], p->lifted, p->geometric),
                             towards, distance);
    return is;
}

static void add_sample(float rgb[3], const relume_objects *o, const struct surface_point *p,
                       vec3 view, const struct relume_object_light *light_sample,
                       const struct lighting *l)
{
    float arriving[3], value[3];
    double distance;
    vec3 towards;
    if (!relume_object_light_at(&towards, arriving, &distance, light_sample, p->position))
        return;
    const vec3 light = local(p, towards);
    if (!(light.z > 0.0))
        return;
    if (!objects_lit(o, p, l, towards, distance))
        return;
    objects_ask(value, o, p, &(struct relume_btf_ray){.view = view, .light = vec3_unit(light)});
    for (int c = 0; c < 3; c++)
        rgb[c] += arriving[c] * value[c];
}

// What environment samples send, each by its cosine, and what of it arrives.
struct sky_sums {
    float sent[3], arrived[3];
};

static void add_to_share(struct sky_sums *s, const relume_objects *o, const struct surface_point *p,
                         const struct lighting *l, const struct relume_light *sample)
{
    const float cosine = (float)vec3_dot(sample->direction, p->normal);
    if (!(cosine > 0.0f))
        return;
    const bool reached = objects_lit(o, p, l, sample->direction, INFINITY);
    for (int c = 0; c < 3; c++) {
        s->sent[c] += cosine * sample->rgb[c];
        s->arrived[c] += reached ? cosine * sample->rgb[c] : 0.0f;
    }
}

static void take_share(float share[3], const struct sky_sums *s)
{
    for (int c = 0; c < 3; c++)
        share[c] = s->sent[c] > 0.0f ? s->arrived[c] / s->sent[c] : 1.0f;
}

void share_of_sky(float share[3], const relume_objects *o, const struct surface_point *p,
                  const struct lighting *l, int number)
{
    const struct sky_light *sky = &l->sky[number];
    struct sky_sums sums = {{0.0f}, {0.0f}};
    const int every = l->every > 1 ? l->every : 1, begin = (int)(l->key % (uint64_t)every);
    for (int i = begin; i < sky->light_samples && !l->no_shadows; i += every)
        add_to_share(&sums, o, p, l, &l->light_sample[sky->first + i].light);
    take_share(share, &sums);
}

void share_in_pattern(float share[3], const relume_objects *o, const struct surface_point *p,
                      const struct lighting *l, int number, int x, int y)
{
    struct sky_sums sums = {{0.0f}, {0.0f}};
    const int n = SKY_PATTERN, first = x % n + n * (y % n);
    for (int i = first; i < SKY_FINE && !l->no_shadows; i += n * n)
        add_to_share(&sums, o, p, l, &l->sky[number].fine[i]);
    take_share(share, &sums);
}

static void add_sky(float rgb[3], const relume_objects *o, const struct surface_point *p, vec3 view,
                    const struct lighting *l, int number)
{
    const struct sky_light *sky = &l->sky[number];
    const float *known = l->shares ? l->shares[number].data + l->pixel : NULL;
    float value[3], share[3];
    objects_ask(value, o, p,
                &(struct relume_btf_ray){.view = view,
                                         .sky = sky->sky[o->part[p->part].material],
                                         .frame = {p->tangent, p->bitangent, p->normal}});
    if (known && !isnan(known[0]))
        memcpy(share, known, sizeof share);
    else
        share_of_sky(share, o, p, l, number);
    for (int c = 0; c < 3; c++)
        rgb[c] += share[c] * value[c];
}

static vec3 view_from(const struct surface_point *p, vec3 eye)
{
    const vec3 view = local(p, vec3_unit(vec3_sub(eye, p->position)));
    return vec3_unit(vec3_of(view.x, view.y, fmax(view.z, LOWEST)));
}

void objects_return(float rgb[3], const relume_objects *o, const struct surface_point *p, vec3 eye,
                    const struct arrival *arrival)
{
    const double GRAZING = 0.05;  // values hold n.l, the arrival's share too
    const vec3 light = local(p, arrival->towards);
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (baked_return(rgb, o, p, eye, arrival) || !(light.z > 0.0) || objects_mirror_at(o, p))
        return;
    const float share = (float)(arrival->share / fmax(light.z, GRAZING));
    objects_ask(rgb, o, p,
                &(struct relume_btf_ray){.view = view_from(p, eye), .light = vec3_unit(light)});
    for (int c = 0; c < 3; c++)
        rgb[c] *= share * arrival->with[c];
}

void objects_shade(float rgb[3], const relume_objects *o, const struct surface_point *p, vec3 eye,
                   const struct lighting *lighting)
{
    if (objects_mirror_at(o, p)) {
        mirror_shade(rgb, o, p, eye, lighting);
        return;
    }
    if (translucent_shade(rgb, lighting, p, eye) || baked_shade(rgb, o, p, eye, lighting))
        return;
    const vec3 view = view_from(p, eye);
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    for (int i = 0; i < lighting->light_samples; i++)
        if (!lighting->light_sample[i].is_sky)
            add_sample(rgb, o, p, view, &lighting->light_sample[i], lighting);
    for (int i = 0; i < lighting->skies; i++)
        add_sky(rgb, o, p, view, lighting, i);
    skin_add_emission(rgb, o, p, lighting->sends);
}

// ---------------------------------------------------------------- pictures

enum { TILE = 16 };

struct picture {
    struct relume_image *out;
    pixel_value *value;
    const void *context;
    int samples, across, first;
};

static void trace_pixel(const struct picture *p, int x, int y)
{
    float *to = p->out->data + 3 * ((size_t)y * (size_t)p->out->width + (size_t)x);
    double sum[3] = {0.0, 0.0, 0.0};
    const int n = p->samples;
    for (int i = 0; i < n * n; i++) {
        float rgb[3];
        p->value(rgb, p->context, x + (i % n + 0.5) / n, y + (i / n + 0.5) / n, 1.0 / n);
        for (int c = 0; c < 3; c++)
            sum[c] += (double)rgb[c];
    }
    for (int c = 0; c < 3; c++)
        to[c] = (float)(sum[c] / (n * n));
}

static void trace_tile(void *context, size_t item, int worker)
{
    (void)worker;
    const struct picture *p = context;
    const int tile = p->first + (int)item;
    const int left = tile % p->across * TILE, top = tile / p->across * TILE;
    for (int y = top; y < top + TILE && y < p->out->height; y++)
        for (int x = left; x < left + TILE && x < p->out->width; x++)
            trace_pixel(p, x, y);
}

relume_status objects_trace(struct relume_image *out, pixel_value *value, const void *context,
                            const struct relume_render_params *params)
{
    enum { AT_ONCE = 64 };
    const int samples = params && params->samples ? params->samples : 1;
    struct picture p = {out, value, context, samples, (out->width + TILE - 1) / TILE, 0};
    const int tiles = p.across * ((out->height + TILE - 1) / TILE);
    if (samples < 1 || samples > 16 || out->channels != 3)
        return RELUME_EINVAL;
    for (; p.first < tiles; p.first += AT_ONCE) {
        const int left = tiles - p.first;
        thread_for(params ? params->threads : 0, (size_t)(left < AT_ONCE ? left : AT_ONCE),
                   trace_tile, &p);
        if (params &&
            !log_progress(params->log, "rendering", fmin((double)(p.first + AT_ONCE) / tiles, 1.0)))
            return RELUME_ECANCEL;
    }
    return RELUME_OK;
}

struct view {
    const relume_objects *o;
    const struct relume_window *window;
    double width, height;
    struct lighting lighting;
    struct seen *seen;
};

static struct ray ray_at(const void *context, double x, double y)
{
    const struct view *v = context;
    const struct relume_window *w = v->window;
    const vec3 at =
        vec3_add(w->corner, vec3_along(vec3_scale(w->right, x / v->width), w->down, y / v->height));
    return (struct ray){w->eye, vec3_unit(vec3_sub(at, w->eye))};
}

static void view_value(float rgb[3], const void *context, double x, double y, double step)
{
    const struct view *v = context;
    const struct ray ray = ray_at(v, x, y), right = ray_at(v, x + step, y),
                     below = ray_at(v, x, y + step);
    struct skin_layers layers = {.left = 1.0f};
    struct surface_point p;
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    while (skin_layer(&p, &layers, v->o, &ray, INFINITY)) {
        float value[3];
        objects_spread(&p, v->o, &ray, &right, &below);
        if (!seen_shade(value, v->seen, &p, ray.origin, x, y))
            objects_shade(value, v->o, &p, ray.origin, &v->lighting);
        for (int c = 0; c < 3; c++)
            rgb[c] += layers.part * value[c];
    }
}

static relume_status render(struct relume_image *out, const relume_objects *objects,
                            const struct relume_window *window, const struct relume_light *lights,
                            int n, const struct relume_render_params *params)
{
    const struct relume_render_params own = *params;
    struct view view = {.o = objects, .window = window, .width = out->width, .height = out->height};
    struct bodies *bodies = NULL;
    objects_say_around(&(bool){false}, objects, window->eye, own.log);
    relume_status status = lighting_create(&view.lighting, objects, lights, n, &own);
    if (!status && surround_lacks(&view.lighting.surround, objects))
        log_line(own.log, RELUME_WARNING, "%s", SURROUND_LACKS);
    if (!status)
        status = bodies_need(&bodies, objects, own.threads, own.log);
    if (!status)
        status = lighting_enters(&view.lighting, objects, bodies, own.threads, own.log);
    if (!status)
        status = seen_create(&view.seen, objects, &view.lighting, out->width, out->height, ray_at,
                             &view, &own);
    if (!status)
        status = objects_trace(out, view_value, &view, &own);
    seen_destroy(&view.seen);
    lighting_destroy(&view.lighting);
    bodies_destroy(&bodies);
    return status;
}

relume_status relume_objects_render(struct relume_image *out, const relume_objects *objects,
                                    const struct relume_window *window,
                                    const struct relume_light *lights, int n,
                                    const struct relume_render_params *params)
{
    const struct relume_render_params own = PARAMS_WORK(relume_render_params, params);
    const double pixel = objects_pixel_of_window(window, out->width, out->height);
    relume_objects *shown = NULL;
    relume_status status = relume_objects_shown(&shown, objects, window->eye, pixel, true);
    if (!status)
        status = render(out, objects_or(shown, objects), window, lights, n, &own);
    relume_objects_destroy(&shown);
    return status;
}

bool relume_objects_window(struct relume_window *out, const relume_objects *objects,
                           struct relume_vec3 eye, const struct relume_look_at *look_at, int width,
                           int height)
{
    const vec3 min = objects->info.min, max = objects->info.max;
    const vec3 middle = vec3_scale(vec3_add(min, max), 0.5);
    const double radius = 0.5 * vec3_length(vec3_sub(max, min));
    const vec3 at = look_at && look_at->aimed ? look_at->at : middle;
    const vec3 ahead = vec3_sub(at, eye);
    const double distance = vec3_length(ahead);
    vec3 up = look_at ? look_at->up : vec3_of(0, 0, 0);
    if (!(distance > 0.0) || !isfinite(distance))
        return false;
    if (!(vec3_length(up) > 0.0))
        up = fabs(ahead.y) > 0.9999 * distance ? vec3_of(0, 0, ahead.y < 0.0 ? -1.0 : 1.0)
                                               : vec3_of(0, 1, 0);
    vec3 right = vec3_cross(ahead, up);
    if (!(vec3_length(right) > 1e-9 * distance * vec3_length(up)))
        return false;
    right = vec3_unit(right);
    const vec3 down = vec3_unit(vec3_cross(ahead, right));
    // half the window at distance 1, along the shorter side; the ball about the objects fills it
    const double apart = fmax(vec3_length(vec3_sub(middle, eye)), 1.2 * radius);
    const double fits = 1.05 * radius / sqrt(apart * apart - radius * radius);
    const double angle_deg = look_at ? look_at->field_of_view_deg : 0.0;
    const double pixel = angle_deg > 0.0 ? tan(angle_deg * M_PI / 360.0) / width
                                         : fits / (width < height ? width : height);
    const vec3 half_right = vec3_scale(right, distance * pixel * width);
    const vec3 half_down = vec3_scale(down, distance * pixel * height);
    *out = (struct relume_window){
        .eye = eye,
        .corner = vec3_sub(vec3_sub(at, half_right), half_down),
        .right = vec3_scale(half_right, 2.0),
        .down = vec3_scale(half_down, 2.0),
    };
    return true;
}
