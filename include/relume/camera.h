// camera.h - where the pixels of a picture lie in the world: poses, projections, slabs, panoramas
#ifndef RELUME_CAMERA_H
#define RELUME_CAMERA_H

#include <relume/base.h>

#ifdef __cplusplus
extern "C" {
#endif

// How the views of a capture lie in the world.
enum relume_projection {
    RELUME_PLANAR = 0,
    RELUME_SLAB,
    RELUME_CYLINDRICAL,
    RELUME_SPHERICAL,
    RELUME_CUBE,
};
// "planar", "slab", "cylindrical", "spherical", "cube"; NULL when out of range.
RELUME_API const char *relume_projection_name(enum relume_projection projection);
// RELUME_EINVAL when `name` is none of these.
RELUME_RESULT relume_status relume_projection_parse(enum relume_projection *out, const char *name);

// A right-handed frame in the world: (x, y, z) of it lies at origin + x axis[0] + y axis[1] +
// z axis[2]. All zero is the world itself.
struct relume_pose {
    struct relume_vec3 origin;   // of the frame, world
    struct relume_vec3 axis[3];  // its x, y and z axis, unit, world
};
// Make the axes unit and perpendicular, all zero the world's; false when they are not those of a
// rotation within 1e-3, or not finite.
RELUME_API bool relume_pose_normalise(struct relume_pose *pose);
// Points of the frame in the world, and the inverse. Directions turn alone.
RELUME_API struct relume_vec3 relume_pose_world(const struct relume_pose *pose,
                                                struct relume_vec3 local);
// A point of the world in the frame.
RELUME_API struct relume_vec3 relume_pose_local(const struct relume_pose *pose,
                                                struct relume_vec3 world);
// A direction of the frame in the world.
RELUME_API struct relume_vec3 relume_pose_turn(const struct relume_pose *pose,
                                               struct relume_vec3 local);
// A direction of the world in the frame.
RELUME_API struct relume_vec3 relume_pose_turn_back(const struct relume_pose *pose,
                                                    struct relume_vec3 world);

// Where the pixels of a view lie in the world. Only the members of `projection` count.
struct relume_geometry {
    enum relume_projection projection;
    // planar: the rectangle of the plane z = 0 that the image shows
    double window_min[2], window_max[2];
    bool perspective;  // eye (0, 0, camera_z) through the window; default: orthographic along -z
    double camera_z;
    // slab: cameras on the plane z = uv_z look through st_min..st_max on the plane z = st_z, all in
    // the frame `pose`
    double uv_z, st_z;
    double st_min[2], st_max[2];
    struct relume_pose pose;
    // cylindrical: the tangents of the lowest and highest elevation, and the cylinder's end discs:
    // below its rows the image goes on by `disc` rows, which hold two squares of that side, at the
    // left the disc at the height v_max, beside it the one at v_min. Each is seen from the eye,
    // touches the borders of its square, right = direction x up, up is +z for the upper, -z for the
    // lower one. What lies beside the discs is no part of the picture. 0: no discs.
    double v_min, v_max;
    int disc;
    // panoramas: the eye
    struct relume_vec3 center;
};

// The geometry that a manifest without one implies for images of this size.
RELUME_API struct relume_geometry relume_geometry_default(enum relume_projection projection,
                                                          int width, int height);

// Towards the eye, where all pixels see it in the same direction: planar views, orthographically;
// else 0.
RELUME_API struct relume_vec3 relume_geometry_eye(const struct relume_geometry *geometry);

#ifdef __cplusplus
}
#endif
#endif
