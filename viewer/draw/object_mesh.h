// object_mesh.h - vertices and triangles of objects on the GPU
#ifndef VIEWER_OBJECT_MESH_H
#define VIEWER_OBJECT_MESH_H

#include "draw/frame_projection.h"
#include "gl/gl.h"

#include <relume/world/object.h>

struct object_mesh {
    const struct gl *gl;
    relume_objects *seen;  // as the eye of the frame sees them; NULL: in full
    GLuint array, vertices, indices;
    GLuint tints;  // 0 where no vertex has one
};

// Uploads the objects. OpenGL's errors show in the next gl_check.
void object_mesh_create(struct object_mesh *m, const struct gl *gl,
                        const struct relume_objects_info *info);
void object_mesh_destroy(struct object_mesh *m);
// Chooses levels of detail for the eye of a frame. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status object_mesh_see(struct object_mesh *m, const relume_objects *objects,
                              const struct frame_projection *projection,
                              const struct relume_log *log);
// Returns the vertices and triangles that are uploaded, with the parts and materials of the
// objects.
const struct relume_objects_info *object_mesh_drawn(const struct object_mesh *m,
                                                    const relume_objects *objects);
// Draws `count` triangles from `first` on, from the array, which is in use.
void object_mesh_draw(const struct object_mesh *m, size_t first, size_t count);

#endif
