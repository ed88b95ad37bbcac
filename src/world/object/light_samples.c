// light_samples.c - lights as samples: whatever shines from more than one direction becomes several
#include "core/base/memory.h"
#include "relight/light/environment.h"
#include "world/object/drawn_objects.h"
#include "world/object/object.h"

#include <relume/light.h>

// Enough for penumbrae and soft shading to look smooth; of an environment they are its shadows.
enum { MOST_SIDE = 6, SKY = RELUME_OBJECT_LIGHTS_MOST };

// How far the objects are from an area light at least.
static double distance_to(const relume_objects *o, const struct relume_light *area)
{
    double least = INFINITY;
    for (size_t i = 0; i < o->mesh.vertex_count; i++) {
        const vec3 d = vec3_sub(vertex_position(&o->mesh.vertices[i]), area->position);
        least = fmin(least, vec3_length(d));
    }
    return least;
}

static int side_of(const relume_objects *o, const struct relume_light *area)
{
    const int side = relume_light_patch_side(area, distance_to(o, area));
    return side < MOST_SIDE ? side : MOST_SIDE;
}

static int count_of(const relume_objects *o, const struct relume_light *light)
{
    if (light->kind == RELUME_LIGHT_ENVIRONMENT)
        return SKY;
    const int side = light->kind == RELUME_LIGHT_AREA ? side_of(o, light) : 1;
    return side * side;
}

static relume_status fill(struct relume_object_light *to, int n, const relume_objects *o,
                          const struct relume_light *light, int number)
{
    struct relume_light_patch patch[MOST_SIDE * MOST_SIDE];
    struct relume_light sky[SKY];
    relume_status status = RELUME_OK;
    if (light->kind == RELUME_LIGHT_AREA)
        relume_light_patches(patch, light, side_of(o, light));
    if (light->kind == RELUME_LIGHT_ENVIRONMENT)
        status = relume_environment_sample(sky, SKY, light, 0);
    for (int i = 0; i < n && !status; i++) {
        to[i] = (struct relume_object_light){.is_patch = light->kind == RELUME_LIGHT_AREA,
                                             .is_sky = light->kind == RELUME_LIGHT_ENVIRONMENT,
                                             .number = number};
        if (to[i].is_patch)
            to[i].patch = patch[i];
        else
            to[i].light = light->kind == RELUME_LIGHT_ENVIRONMENT ? sky[i] : *light;
        if (to[i].light.kind == RELUME_LIGHT_DIRECTIONAL && !to[i].is_patch)
            to[i].light.direction = vec3_unit(to[i].light.direction);
    }
    return status;
}

relume_status relume_objects_lights(struct relume_object_light **out, int *n,
                                    const relume_objects *objects,
                                    const struct relume_light *lights, int count)
{
    size_t total = 0, at = 0;
    *out = NULL;
    *n = 0;
    for (int i = 0; i < count; i++) {
        if (relume_light_check(&lights[i], "light", NULL))
            return RELUME_EINVAL;
        total += (size_t)count_of(objects, &lights[i]);
    }
    struct relume_object_light *light_samples = mem_array(total, sizeof *light_samples);
    relume_status status = light_samples ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; i < count && !status; i++) {
        const int own = count_of(objects, &lights[i]);
        status = fill(light_samples + at, own, objects, &lights[i], i);
        at += (size_t)own;
    }
    if (status)
        mem_free(light_samples);
    else
        *out = light_samples, *n = (int)total;
    return status;
}

bool relume_object_light_at(struct relume_vec3 *towards, float rgb[3], double *distance,
                            const struct relume_object_light *light_sample,
                            struct relume_vec3 point)
{
    *distance = INFINITY;
    if (!light_sample->is_patch && !relume_light_is_near(light_sample->light.kind)) {
        *towards = light_sample->light.direction;
        for (int c = 0; c < 3; c++)
            rgb[c] = light_sample->light.rgb[c];
        return true;
    }
    const vec3 from =
        light_sample->is_patch ? light_sample->patch.position : light_sample->light.position;
    *distance = vec3_length(vec3_sub(from, point));
    return light_sample->is_patch ? relume_light_patch_at(towards, rgb, &light_sample->patch, point)
                                  : relume_light_at(towards, rgb, &light_sample->light, point);
}
