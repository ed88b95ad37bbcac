// scene.h - the inside of a relume_scene
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include "shape/mesh/trace.h"
#include "world/stage/build.h"

struct relume_scene {
    const struct relume_scene_kind *kind;
    struct relume_scene_builder stage;
    struct bounds bounds;  // of the mesh
    tracer *tracer;
};

extern const struct relume_scene_kind scene_box, scene_teapot, scene_bust, scene_attic,
    scene_chessboard, scene_colonnade, scene_cornell;

#endif
