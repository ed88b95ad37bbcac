// object_lights.h - the lights of objects, and the light samples that approximate them
#ifndef VIEWER_OBJECT_LIGHTS_H
#define VIEWER_OBJECT_LIGHTS_H

#include "world/object/drawn_objects.h"

#include <relume/world/object.h>

// Zeroed there are no lights.
struct object_lights {
    struct relume_light *light;  // [lights]
    int lights;
    struct relume_object_light *sample;  // [samples] of all lights
    int samples;
};

// Copies lights; their pictures must live as long. RELUME_ENOMEM, RELUME_EINVAL.
relume_status object_lights_set(struct object_lights *l, const relume_objects *objects,
                                const struct relume_light *lights, int n);
void object_lights_destroy(struct object_lights *l);
// A light sample as a light: a patch is an area light's piece, its normal the axis.
struct relume_light object_lights_of(const struct relume_object_light *sample);

#endif
