// captured_mesh.h - a captured panorama as a mesh that throws shadows, made of its places by a
// vertex shader. Twin: scenery.c
#ifndef VIEWER_CAPTURED_MESH_H
#define VIEWER_CAPTURED_MESH_H

#include "gl/program.h"
#include "gl/target.h"

#include <relume/capture.h>

// Zeroed it is nothing.
struct captured_mesh {
    const struct gl *gl;
    struct program program;
    GLuint array;                   // without a vertex
    const struct target *places;    // of the panorama
    struct relume_vec3 centre;      // its eye
    int block;                      // pixels along each side of a vertex
    bool wraps;                     // the last column borders on the first
    double farthest, least_cosine;  // between neighbours
};

// Of a panorama whose pixels see `places`, which must outlive it. RELUME_ESYSTEM, RELUME_ENOMEM.
relume_status captured_mesh_create(struct captured_mesh *mesh, const struct gl *gl,
                                   const struct relume_geometry *geometry,
                                   const struct target *places, const struct relume_log *log);
void captured_mesh_destroy(struct captured_mesh *mesh);
// Into the depth buffer in use.
void captured_mesh_draw(const struct captured_mesh *mesh, const float clip[16]);

#endif
