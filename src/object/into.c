// into.c - objects in a relit scene
#include "base/log.h"
#include "base/memory.h"
#include "base/thread.h"
#include "object/object.h"

#include <relume/sight.h>
#include <string.h>

// ---------------------------------------------------------------- the scene, in their shadow

struct shadows {
    const relume_objects *o;
    const struct relume_image *places, *lone;
    struct relume_image *sum;
    const struct relume_lamp *lamps;
    int n;
    bool none;
};

// The share of a light that reaches a point. One lamp does or does not; of the lamps of an area or
// an environment each counts by its value.
static double share(const struct shadows *s, vec3 point)
{
    double sent = 0.0, arrived = 0.0;
    for (int i = 0; i < s->n; i++) {
        float unused[3];
        double distance;
        vec3 towards;
        const struct relume_lamp *lamp = &s->lamps[i];
        const float *rgb = lamp->is_facet ? lamp->facet.rgb : lamp->light.rgb;
        const double value = (double)(rgb[0] + rgb[1] + rgb[2]);
        sent += value;
        (void)relume_lamp_at(&towards, unused, &distance, lamp, point);
        if (objects_reached(s->o, point, vec3_of(0, 0, 0), towards, distance))
            arrived += value;
    }
    return sent > 0.0 ? arrived / sent : 1.0;
}

static void add_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct shadows *s = context;
    const size_t width = (size_t)s->sum->width, first = 3 * row * width;
    for (size_t i = first; i < first + 3 * width; i += 3) {
        const float *p = s->places->data + i, *lone = s->lone->data + i;
        const bool lit = lone[0] != 0.0f || lone[1] != 0.0f || lone[2] != 0.0f;
        const double part =
            lit && !s->none ? share(s, vec3_of((double)p[0], (double)p[1], (double)p[2])) : 1.0;
        for (size_t c = 0; c < 3; c++)
            s->sum->data[i + c] += (float)(part * (double)lone[c]);
    }
}

static relume_status add_light(struct shadows *s, relume_pack *pack,
                               const struct relume_camera *camera, const struct relume_light *light,
                               const struct relume_frame_params *frame, int threads)
{
    struct relume_image lone;
    struct relume_lamp *lamps;
    relume_status status = relume_objects_lamps(&lamps, &s->n, s->o, light, 1);
    if (status)
        return status;
    status = relume_frame(&lone, pack, camera, light, 1, frame);
    s->lamps = lamps;
    s->lone = &lone;
    if (!status)
        thread_for(threads, (size_t)lone.height, add_row, s);
    relume_image_destroy(&lone);
    free(lamps);
    return status;
}

// ---------------------------------------------------------------- both together

struct layered {
    const relume_objects *o;
    const struct relume_sight *sight;
    const struct relume_image *scene, *places;
    const struct lighting *lighting;
};

static struct ray ray_of(const struct relume_sight *sight, double x, double y)
{
    struct ray ray;
    relume_sight_ray(&ray.origin, &ray.direction, sight, x, y);
    return ray;
}

static void layered_value(float rgb[3], const void *context, double x, double y, double step)
{
    const struct layered *l = context;
    const size_t pixel = 3 * ((size_t)y * (size_t)l->scene->width + (size_t)x);
    const float *p = l->places->data + pixel;
    struct surface_point point;
    const struct ray ray = ray_of(l->sight, x, y), right = ray_of(l->sight, x + step, y),
                     below = ray_of(l->sight, x, y + step);
    const vec3 to = vec3_sub(vec3_of((double)p[0], (double)p[1], (double)p[2]), ray.origin);
    const bool nothing = p[0] == 0.0f && p[1] == 0.0f && p[2] == 0.0f;  // no view sees so far
    memcpy(rgb, l->scene->data + pixel, 3 * sizeof *rgb);
    if (!objects_hit(&point, l->o, ray.origin, ray.direction) ||
        !(nothing || point.distance < vec3_dot(to, ray.direction)))
        return;
    objects_spread(&point, l->o, &ray, &right, &below);
    objects_shade(rgb, l->o, &point, vec3_scale(ray.direction, -1.0), l->lighting);
}

static relume_status layer(struct relume_image *out, const struct layered *l,
                           const struct relume_render_params *params)
{
    relume_status status = relume_image_create(out, l->scene->width, l->scene->height, 3);
    return status ? status : objects_trace(out, layered_value, l, params);
}

static relume_status light_scene(struct relume_image *scene, const struct relume_image *places,
                                 const relume_objects *o, relume_pack *pack,
                                 const struct relume_camera *camera,
                                 const struct relume_light *lights, int n,
                                 const struct relume_frame_params *frame,
                                 const struct relume_render_params *params)
{
    struct shadows s = {
        .o = o, .places = places, .sum = scene, .none = params && params->no_shadows};
    relume_status status = relume_image_create(scene, places->width, places->height, 3);
    for (int i = 0; i < n && !status; i++)
        status = add_light(&s, pack, camera, &lights[i], frame, params ? params->threads : 0);
    return status;
}

relume_status relume_objects_frame(struct relume_image *out, const relume_objects *objects,
                                   relume_pack *pack, const struct relume_camera *camera,
                                   const struct relume_light *lights, int n,
                                   const struct relume_frame_params *frame,
                                   const struct relume_render_params *params)
{
    struct relume_frame_params light = frame ? *frame : (struct relume_frame_params){0};
    struct relume_frame_params place = light;
    struct relume_image places, scene = {0};
    struct lighting lighting = {0};
    *out = (struct relume_image){0};
    if (light.pass != RELUME_PASS_COLOUR)
        return log_fail(light.log, RELUME_EINVAL, "objects are seen in colour; expected no pass");
    place.places = true;
    relume_status status = relume_frame(&places, pack, camera, NULL, 0, &place);
    struct relume_sight sight;
    if (!status)
        status = relume_frame_sight(&sight, pack, camera, places.width, places.height);
    if (!status)
        status = lighting_create(&lighting, objects, lights, n, params);
    if (!status)
        status = light_scene(&scene, &places, objects, pack, camera, lights, n, &light, params);
    const struct layered layers = {objects, &sight, &scene, &places, &lighting};
    if (!status)
        status = layer(out, &layers, params);
    if (status)
        relume_image_destroy(out);
    relume_image_destroy(&scene);
    relume_image_destroy(&places);
    lighting_destroy(&lighting);
    return status;
}
