// object_surface.h - the surface of objects in a frame: textures of positions and frames
#ifndef VIEWER_OBJECT_SURFACE_H
#define VIEWER_OBJECT_SURFACE_H

#include "draw/object_parts.h"
#include "gl/target.h"

struct object_surface {
    struct program program;
    struct target position, normal, tangent, footprint;
    struct target tint, emitted;  // only where vertices have tints or materials send light
    GLuint depth, framebuffer;
    int grid;  // pixels of the surface along each side of a pixel of the frame
};

// RELUME_ESYSTEM.
relume_status object_surface_create(struct object_surface *s, const struct gl *gl,
                                    const struct relume_log *log);
void object_surface_destroy(struct object_surface *s, const struct gl *gl);
// Makes the textures for a frame of width x height; `coloured`: with tints and emission.
// RELUME_ESYSTEM.
relume_status object_surface_need(struct object_surface *s, const struct gl *gl, int width,
                                  int height, bool coloured, const struct relume_log *log);
// Draws the parts as the eye of the frame sees them.
void object_surface_draw(const struct object_surface *s, const struct object_parts *parts,
                         const struct frame_projection *projection);

// target_join for what is drawn of objects.
// RELUME_ESYSTEM.
relume_status object_surface_join(GLuint *out, const struct gl *gl,
                                  const struct target *const *target, int n, GLuint depth,
                                  const struct relume_log *log);

#endif
