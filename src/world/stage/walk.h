// walk.h - from the eye into the scene: the places whose light a pixel gathers
//
// One camera sample is followed once. It leaves a few places, each with the weight at which light
// arriving there reaches the eye: the surface seen, surfaces seen in mirrors, and with indirect
// bounces the places that those surfaces see (path tracing with next-event estimation, Kajiya
// 1986). The places do not depend on the light, so every light of the stage uses the same ones.
#ifndef SCENE_WALK_H
#define SCENE_WALK_H

#include "image/geometry/camera.h"
#include "world/stage/scene.h"

struct place {
    struct surface surface;
    float origin[3];  // where shadow rays start: just off the surface
    float weight[3];
    uint32_t pixel;  // of the walk
};

// Zero-filled is empty. `failed` is set when memory runs out.
struct places {
    struct place *at;
    size_t count;
    bool failed;
};
void places_destroy(struct places *places);

struct walk {
    const relume_scene *scene;
    int bounces;
    struct random random;
    float first_bounce[2];  // uniform; spread evenly over the samples of a pixel
    struct places *places;
    uint32_t pixel;
};
void walk_from_eye(struct walk *walk, struct camera_ray ray);

#endif
