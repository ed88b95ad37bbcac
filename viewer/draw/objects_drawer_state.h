// objects_drawer_state.h - what objects keep on the GPU
#ifndef VIEWER_OBJECTS_DRAWER_STATE_H
#define VIEWER_OBJECTS_DRAWER_STATE_H

#include "draw/baked.h"
#include "draw/btf_upload.h"
#include "draw/captured_mesh.h"
#include "draw/draw.h"
#include "draw/shadow_map.h"
#include "draw/frame_projection.h"
#include "draw/mirrors.h"
#include "draw/sky_maps.h"

struct objects_drawer_program {
    struct program program;
    const struct btf_shader *shader;
    bool sky;  // for environments
};

struct objects_drawer {
    const struct gl *gl;
    const struct relume_log *log;
    relume_objects *objects;                 // borrowed
    relume_objects *seen;                    // as the eye of the frame sees them; NULL: in full
    GLuint array, vertices, indices, tints;  // the last: 0 where no vertex has one
    struct program surface, depth, over, cast, share, sky;
    struct objects_drawer_program *program;  // [programs]: of the models in use
    int programs;
    struct btf_material *material;  // [materials]; without a shader until it is shown
    struct light_uniforms uniforms;
    struct sky_maps maps;
    struct mirrors mirrors;
    struct baked_drawer baked;
    struct mirror_panorama panorama;  // that they show, of the present frame
    struct shadow_map shadow;
    // Of the frame, `grid` times finer; `other` is in another material, to compare with.
    struct target place, normal, tangent, footprint, tint, emitted, shaded, other;
    struct target shown, sent, arrived;  // of an environment
    GLuint surface_buffer, depth_texture, share_buffer;
    int grid;
    GLuint *skin;       // [materials]: opacity and emission, 0 where there is none
    bool sends, holes;  // some material does; has some
    int only;           // material of all parts in the present frame; -1: their own
    bool no_shadows;
    const struct captured_mesh *captured;  // that throws shadows on objects as well; NULL: none
    GLuint returned;  // light of the scene that objects show, a texture of the frame; 0: none
    struct relume_object_light *light_sample;  // of the present frame, and its lights
    int light_samples;
    struct relume_light *light;
    int lights;
    struct frame_projection projection;
    struct relume_vec3 middle;
    double radius;
};

#endif
