// micro.h - light gathered by small pictures of what surrounds each place, by compute passes.
// Twin: transport/micro.c
//
// It differs from that file in this: points of objects return light as their material does even
// light, what is too near to be drawn is met as discs of points, holes show what is beside them,
// and pictures are not warped by materials.
#ifndef VIEWER_MICRO_H
#define VIEWER_MICRO_H

#include "transport/card_points.h"

enum { MICRO_LEAST = 4, MICRO_MOST = 24 };  // pixels along the side of a picture

// Zeroed it is nothing.
struct micro {
    const struct gl *gl;
    const struct relume_log *log;
    struct program gather, leaves, up, between;
    int side;                        // of the pictures that `gather` and `picture` are for
    GLuint picture, list;            // buffers
    int listed;                      // pixels that the list has room for
    float whole;                     // of the pictures' pixels
    struct target gathered, unused;  // by leaves
};

// RELUME_ESYSTEM.
relume_status micro_create(struct micro *m, const struct gl *gl, const struct relume_log *log);
void micro_destroy(struct micro *m);

// All passes of a frame know this.
struct micro_view {
    const struct card_points *points;
    struct relume_vec3 centre, eye;  // that captured the panorama; of the frame
    double radius;                   // of the ball about the objects
    int samples;                     // pixels of pictures, about
    int spacing, bounces;
    float sends;  // as between_view
};

// Points send what they do under a light: the scene what `panorama` shows, dimmed as `let_without`
// and `let_with` (of leaves, lamps.frag) and `mean` have it. RELUME_ESYSTEM.
relume_status micro_light(struct micro *m, const struct micro_view *view,
                          const struct target *panorama, const struct target *mean,
                          const struct target *let_without, const struct target *let_with);
// Into `without` and `with_objects`, which are black: at pixels whose place has that alpha.
struct micro_sites {
    const struct target *place, *facing;
    float kind;
    bool of_scene;  // else of objects
    const struct target *without, *with_objects;
};
void micro_gather(struct micro *m, const struct micro_view *view, const struct micro_sites *sites);

#endif
