// baked.h - baked objects on the GPU: lights are summed up beforehand, so that a part is one draw
#ifndef VIEWER_BAKED_H
#define VIEWER_BAKED_H

#include "draw/draw.h"

#include <relume/world/bake.h>

enum { BAKED_BUFFERS = 4 };

// What a material needs; zeroed it holds nothing.
struct baked_material {
    GLuint texture[BAKED_BUFFERS], buffer[BAKED_BUFFERS];
    size_t bytes;
    bool lit;  // its colours are those of the present lights
};

// Zeroed but for these two, which must outlive it, it holds nothing.
struct baked_drawer {
    const struct gl *gl;
    const struct relume_log *log;
    struct program program;           // made when it is needed
    struct baked_material *material;  // [materials]
    int materials;
};

// Where the surface is drawn: parts, places, normals, tangents.
struct baked_surface {
    const struct target *place, *normal, *tangent;
    const float *eye;  // as frame_projection
};
// The lights of the next frames are others.
void baked_unlight(struct baked_drawer *drawer);
// Adds to the target in use what part `part` shows in the baked `material`. RELUME_ESYSTEM,
// RELUME_ENOMEM.
relume_status baked_draw(struct baked_drawer *drawer, const relume_objects *objects, int part,
                         int material, const struct baked_surface *surface,
                         const struct relume_light *lights, int n);
// The graphics memory of a material; 0 while it was not shown.
size_t baked_bytes(const struct baked_drawer *drawer, int material);
void baked_forget(struct baked_drawer *drawer);

#endif
