// object_lights.c - the lights of objects, and the light samples that approximate them
#include "draw/object_lights.h"
#include "world/object/drawn_objects.h"

#include <stdlib.h>
#include <string.h>

relume_status object_lights_set(struct object_lights *l, const relume_objects *objects,
                                const struct relume_light *lights, int n)
{
    struct relume_light *light = realloc(l->light, ((size_t)n + 1) * sizeof *light);
    if (!light)
        return RELUME_ENOMEM;
    memcpy(light, lights, (size_t)n * sizeof *light);
    l->light = light;
    l->lights = n;
    relume_free(l->sample);
    return relume_objects_lights(&l->sample, &l->samples, objects, lights, n);
}

void object_lights_destroy(struct object_lights *l)
{
    relume_free(l->sample);
    free(l->light);
    *l = (struct object_lights){.lights = 0};
}

struct relume_light object_lights_of(const struct relume_object_light *sample)
{
    struct relume_light light = sample->light;
    if (!sample->is_patch)
        return light;
    light = (struct relume_light){.kind = RELUME_LIGHT_AREA, .position = sample->patch.position};
    memcpy(light.rgb, sample->patch.rgb, sizeof light.rgb);
    return light;
}
