// ism.h - light gathered from virtual lights with imperfect shadow maps, by compute shaders. Twins:
// world/transport/instant.c, world/transport/virtual.c, world/transport/maps.c.
//
// It differs from these in this: virtual lights are leaves of the trees of points, drawn by how
// bright these are from the root down; points of objects return light as their material does even
// light.
#ifndef VIEWER_ISM_H
#define VIEWER_ISM_H

#include "transport/point_light.h"

enum { ISM_PATTERN = 8 };  // so many pixels each way share the lights

// Zeroed it is nothing.
struct ism {
    const struct gl *gl;
    const struct relume_log *log;
    struct program lights, maps, gather;
    int size;                    // of maps, in texels, that `maps` and `gather` are for
    GLuint light, light_texels;  // buffer, and the same as a texture
    GLuint atlas[2];             // of the scene, of the objects
    int capacity;                // lights, of that size
    int on_scene, all;           // of the last light
};

// RELUME_ESYSTEM.
relume_status ism_create(struct ism *s, const struct gl *gl, const struct relume_log *log);
void ism_destroy(struct ism *s);

// Memory for lights: `samples` on the scene for each pixel of a pattern, and a quarter more on
// objects. RELUME_ESYSTEM with a sentence where there is none.
relume_status ism_need(struct ism *s, int samples);
// Points send what they do under a light, and lights are drawn from them. RELUME_ESYSTEM.
relume_status ism_light(struct ism *s, struct point_light *light, const struct points_view *view,
                        const struct points_lit *lit);
// All sites gather; neighbours are to be smoothed.
void ism_gather(const struct ism *s, const struct points_view *view,
                const struct points_sites *sites);

#endif
