// render.h - one view of a scene under many lights
#ifndef SCENE_RENDER_H
#define SCENE_RENDER_H

#include "world/stage/walk.h"

struct render_job {
    const relume_scene *scene;
    struct camera camera;
    const vec3 *lights;  // unit directions, or places where they are near
    int light_count;
    bool near;  // a lamp is as strong at the world's origin as a distant light, and falls off
    int samples, bounces;
    uint64_t seed;
    int threads;
};

// Gets the share of the view that is done; false stops.
typedef bool render_progress(void *user, double done);

// out[light]: images of the camera's size with three channels, made by the caller.
// Returns RELUME_ENOMEM, RELUME_ECANCEL.
relume_status render_lights(const struct render_job *job, struct relume_image *out,
                            render_progress *progress, void *user);

// Distance from the eye along each pixel's central ray; inf where there is nothing.
void render_depth(const struct render_job *job, struct relume_image *out);

#endif
