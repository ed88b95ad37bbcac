// frame_projection.h - where objects stand in the frame: a matrix for OpenGL, and the eye
#ifndef VIEWER_FRAME_PROJECTION_H
#define VIEWER_FRAME_PROJECTION_H

#include "app/view_geometry.h"

struct frame_projection {
    float clip[16];  // columns first; rows of the frame run down
    float eye[4];    // its place, 1; or the direction towards it, 0
    double pixel;    // what it sees at a distance of 1 under a pixel; 0: of parallel rays
};

// Through a window that `picture`, in pixels of a frame of width x height, shows; objects are
// between `min` and `max`. False when all of them are behind the eye.
bool frame_projection_of_window(struct frame_projection *out, const struct relume_window *window,
                                struct app_rectangle picture, int width, int height,
                                struct relume_vec3 min, struct relume_vec3 max);
// Of parallel rays along -z: a rectangle of the plane z = 0 is the picture.
void frame_projection_of_plane(struct frame_projection *out, const double window_min[2],
                               const double window_max[2], struct app_rectangle picture, int width,
                               int height, struct relume_vec3 min, struct relume_vec3 max);

#endif
