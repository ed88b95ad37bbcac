// camera.h - the viewing rays of every projection that a capture knows (conventions: capture.h)
#ifndef GEOMETRY_CAMERA_H
#define GEOMETRY_CAMERA_H

#include "core/math/vec.h"

#include <relume/camera.h>

struct camera {
    struct relume_geometry geometry;
    int width, height;
    double uv[2];  // slab: where this view's camera stands
    // A sample of material, seen from the unit direction `towards`: parallel rays through the unit
    // square about the origin of the plane z = 0, whose places are the picture's. Rays start on the
    // plane z = geometry.camera_z.
    bool rectified;
    vec3 towards;
};

struct camera_ray {
    vec3 origin;
    vec3 direction;  // unit
};

// Through (x, y) in pixels from the upper left corner of the image; pixel centres at +0.5.
struct camera_ray camera_ray_at(const struct camera *camera, double x, double y);

#endif
