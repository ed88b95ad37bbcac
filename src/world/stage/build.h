// build.h - what a scene file uses to put its things on the stage
#ifndef SCENE_BUILD_H
#define SCENE_BUILD_H

#include "core/math/random.h"
#include "world/stage/material.h"
#include "world/stage/shapes.h"

#include <relume/world/scene.h>

enum { MAX_MATERIALS = 64, MAX_PICTURES = 8 };

struct relume_scene_builder {
    const struct relume_log *log;
    const char *mesh_path;  // --mesh, or NULL
    struct mesh mesh;
    struct material materials[MAX_MATERIALS];
    int material_count;
    struct relume_image pictures[MAX_PICTURES];
    int picture_count;
    struct frame frame;    // where parts are put; scenes set it as they go
    struct random random;  // the scene's own fixed stream
};

// The new material's number.
uint32_t build_material(struct relume_scene_builder *b, struct material material);
// A rough surface of one colour; the commonest material.
struct material build_matte(float r, float g, float b);
// Put a copy of `part` at the current frame, its solid texture shifted at random, and empty `part`.
void build_put(struct relume_scene_builder *b, struct mesh *part, uint32_t material);
// The same without the shift: for checkers and pictures, which must stay where they are.
void build_put_exact(struct relume_scene_builder *b, struct mesh *part, uint32_t material);
// A surface of revolution at the current frame, as shape_lathe.
void build_lathe(struct relume_scene_builder *b, const struct lathe_point *profile, int points,
                 int steps, int sides, uint32_t material);
// A chamfered box at the current frame.
void build_box(struct relume_scene_builder *b, vec3 min, vec3 max, double edge, uint32_t material);
// A chamfered beam of square section `width` x `height` between two points; its texture's x axis
// runs along it.
void build_beam(struct relume_scene_builder *b, vec3 from, vec3 to, double width, double height,
                uint32_t material);

#endif
