// places.h - pictures whose pixels are places or directions
#ifndef MESH_PLACES_H
#define MESH_PLACES_H

#include "core/math/vec.h"

#include <relume/image.h>

static inline vec3 places_at(const struct relume_image *places, size_t pixel)
{
    return vec3_floats(places->data + 3 * pixel);
}

static inline vec3 places_at_xy(const struct relume_image *places, int x, int y)
{
    return places_at(places, (size_t)y * (size_t)places->width + (size_t)x);
}

static inline void places_put(const struct relume_image *places, size_t pixel, vec3 v)
{
    vec3_store(places->data + 3 * pixel, v);
}

#endif
