// shadow_map.h - what a light sample sees of the objects: depths, for shadow.glsl
//
// The objects alone throw shadows, so the map of a distant light sample and of one outside the ball
// about them is one picture of that ball; a light sample inside looks to all six sides.
#ifndef VIEWER_SHADOW_MAP_H
#define VIEWER_SHADOW_MAP_H

#include "gl/program.h"
#include "world/object/drawn_objects.h"

#include <relume/world/object.h>

enum { SHADOW_LAYERS = 6 };

struct shadow_map {
    const struct gl *gl;
    int side;  // texels
    GLuint texture, framebuffer;
    int layers;  // in use; 0: no shadows
    float clip[SHADOW_LAYERS][16];
    float light[4], texel;  // as shadow.glsl
};

// RELUME_ESYSTEM.
relume_status shadow_map_create(struct shadow_map *map, const struct gl *gl, int side,
                                const struct relume_log *log);
void shadow_map_destroy(struct shadow_map *map);

// Aim it; `middle` and `radius` are those of the ball. Then each layer is drawn by `draw` with its
// matrix (columns first), into the depth buffer in use.
void shadow_map_fill(struct shadow_map *map, const struct relume_object_light *light_sample,
                     struct relume_vec3 middle, double radius,
                     void (*draw)(void *context, const float clip[16]), void *context);

// The uniforms of shadow.glsl, one after the other.
enum { SHADOW_MAP, SHADOW_CLIP, SHADOW_LAYER_COUNT, SHADOW_LIGHT, SHADOW_TEXEL, SHADOW_UNIFORMS };
#define SHADOW_NAMES "shadow", "shadow_clip", "shadow_layers", "shadow_light", "shadow_texel"
// Set those of the program in use, by way of texture unit `unit`; `map` NULL: nothing is in shadow.
void shadow_map_use(const struct shadow_map *map, const struct gl *gl, const GLint *at, int unit);

#endif
