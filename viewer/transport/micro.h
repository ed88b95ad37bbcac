// micro.h - light gathered by small pictures of what surrounds each place, by compute shaders.
// Twin: world/transport/micro.c.
//
// It differs from that file in this: points of objects return light as their material does even
// light, what is too near to be drawn is met as discs of points, holes show what is beside them,
// and pictures are not warped by materials.
#ifndef VIEWER_MICRO_H
#define VIEWER_MICRO_H

#include "transport/point_light.h"

enum { MICRO_LEAST = 4, MICRO_MOST = 24 };  // pixels along the side of a picture

// Zeroed it is nothing.
struct micro {
    const struct gl *gl;
    const struct relume_log *log;
    struct program gather, between;
    int side;              // of the pictures that `gather` and `picture` are for
    GLuint picture, list;  // buffers
    int listed;            // pixels that the list holds
    float whole;           // of the pictures' pixels
};

// RELUME_ESYSTEM.
relume_status micro_create(struct micro *m, const struct gl *gl, const struct relume_log *log);
void micro_destroy(struct micro *m);

// Pictures of about so many pixels. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status micro_need(struct micro *m, int samples);
// Points send what they do under a light. View.samples are pixels of pictures. RELUME_ESYSTEM,
// RELUME_ENOMEM.
relume_status micro_light(struct micro *m, struct point_light *light,
                          const struct points_view *view, const struct points_lit *lit);
// Sites gather: every `spacing`-th pixel, and between them those that differ.
void micro_gather(struct micro *m, const struct points_view *view,
                  const struct points_sites *sites);

#endif
