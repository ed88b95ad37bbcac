// sky_maps.h - prefiltered environments as textures, kept by environment: turning or dimming one
// changes none
#ifndef VIEWER_SKY_MAPS_H
#define VIEWER_SKY_MAPS_H

#include "gl/gl.h"
#include "material/model/environment.h"

struct sky_map {
    uint64_t of;  // fingerprint of the environment
    double rim;
    relume_prefiltered_maps *prefiltered;
    GLuint texture;  // sky.glsl
    struct sky_map *next;
};

// Zeroed but for these two, which must outlive it, it holds nothing.
struct sky_maps {
    const struct gl *gl;
    const struct relume_log *log;
    struct sky_map *map;
};

// The maps of an environment light for a material, its rotation and colour left out.
// RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status sky_maps_find(const struct sky_map **out, struct sky_maps *maps,
                            const struct relume_light *light, double rim);
void sky_maps_forget(struct sky_maps *maps);

#endif
