// between_frame.h - targets of light between a panorama and objects in a frame
#ifndef VIEWER_BETWEEN_FRAME_H
#define VIEWER_BETWEEN_FRAME_H

#include "draw/joined.h"

// Zeroed it holds nothing.
struct between_frame {
    struct joined nearest;   // the scene's normals; positions and normals of the nearest
    struct joined by_lamps;  // let through without the objects and with them, all likewise
    struct joined gathered, smoothed;  // without the objects, with them
    struct target behind, show, thrown;
    GLuint behind_depth;
    struct target even;  // the mean of the panorama, a texel
    struct target sum;   // as large as the surface of objects: all lights so far
    int lights;          // that are summed
};

// Makes what does not depend on the frame, and looks whether so many targets can be drawn at once.
// RELUME_ESYSTEM.
relume_status between_frame_create(struct between_frame *f, const struct gl *gl,
                                   const struct relume_log *log);
void between_frame_destroy(struct between_frame *f, const struct gl *gl);
// Makes the targets of a frame of width x height whose objects' surface is as large as `surface`.
// RELUME_ESYSTEM.
relume_status between_frame_need(struct between_frame *f, const struct gl *gl, int width,
                                 int height, const struct target *surface,
                                 const struct relume_log *log);

#endif
