// mirrors.h - mirrors among objects, on the GPU: a draw over the surface for each part that is one
#ifndef VIEWER_MIRRORS_H
#define VIEWER_MIRRORS_H

#include "draw/draw.h"
#include "draw/mirror_distances.h"

#include <relume/world/object.h>

// The relit panorama that mirrors show, with the places that it shows; without one they show
// environments.
struct mirror_panorama {
    const struct relume_geometry *geometry;  // NULL: none
    const struct target *view, *places;
};

// An environment map as a texture.
struct mirror_sky {
    uint64_t of;  // fingerprint of the environment
    GLuint texture;
};

// Zeroed but for these two, which must outlive it, it holds nothing.
struct mirrors {
    const struct gl *gl;
    const struct relume_log *log;
    struct program sphere, panorama;  // made when they are needed
    struct mirror_sky *sky;           // [skies]
    int skies;
    GLuint edit, edit_buffer;
    struct mirror_distances distances;
    bool said;
};

// What a mirror shows where the surface is drawn: parts, places, normals.
struct mirror_surface {
    const struct target *place, *normal;
    const struct target *triangle;  // x: its number
    GLuint vertices, triangles;     // buffers: relume_objects_info's
    const float *eye;               // as frame_projection
};
// Adds to the target in use what part `part` shows in the mirror `material`. RELUME_ESYSTEM,
// RELUME_ENOMEM.
relume_status mirrors_draw(struct mirrors *mirrors, const relume_objects *objects, int part,
                           int material, const struct mirror_surface *surface,
                           const struct mirror_panorama *panorama,
                           const struct relume_light *lights, int n);
void mirrors_forget(struct mirrors *mirrors);

#endif
