// objects_drawer_state.h - what objects keep on the GPU
#ifndef VIEWER_OBJECTS_DRAWER_STATE_H
#define VIEWER_OBJECTS_DRAWER_STATE_H

#include "draw/baked.h"
#include "draw/mirrors.h"
#include "draw/object_lights.h"
#include "draw/object_materials.h"
#include "draw/object_mesh.h"
#include "draw/object_shadows.h"
#include "draw/object_skins.h"
#include "draw/object_surface.h"
#include "draw/sky_maps.h"
#include "relit/light_uniforms.h"

// Environments on objects (object_sky.c).
struct object_sky {
    struct program share, sky;
    struct sky_maps maps;
    struct target shown;          // what materials show of an environment in the open
    struct target sent, arrived;  // light of its samples, and what of that is not in shadow
    GLuint share_buffer;          // draws into both
};

struct objects_drawer {
    const struct gl *gl;
    const struct relume_log *log;
    relume_objects *objects;  // borrowed
    struct object_mesh mesh;
    struct object_skins skins;
    struct object_materials materials;
    struct object_lights lights;  // of the present frame
    struct object_shadows shadows;
    struct object_sky sky;
    struct light_uniforms uniforms;
    struct mirrors mirrors;
    struct mirror_panorama panorama;  // that they show, of the present frame
    struct baked_drawer baked;
    // Of the frame, all as large as the surface; `other` is in another material, to compare with.
    struct object_surface surface;
    struct target shaded, other;
    struct program over;
    GLuint returned;  // light of the scene that objects show, a texture of the frame; 0: none
    struct frame_projection projection;
    int only;  // material of all parts in the present frame; -1: their own
};

#endif
