// camera.h - the viewing rays of every projection that a capture knows (conventions: capture.h)
#ifndef SCENE_CAMERA_H
#define SCENE_CAMERA_H

#include "math/vec.h"

#include <relume/capture.h>

struct camera {
    struct relume_geometry geometry;
    int width, height;
    double uv[2];  // slab: where this view's camera stands
};

struct camera_ray {
    vec3 origin;
    vec3 direction;  // unit
};

// Through (x, y) in pixels from the upper left corner of the image; pixel centres at +0.5.
struct camera_ray camera_ray_at(const struct camera *camera, double x, double y);

#endif
