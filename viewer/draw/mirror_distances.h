// mirror_distances.h - distances along the surface of edited reflections, on the GPU
//
// Of each constraint or region that measures along the surface there is a field: a distance for
// each vertex. Fields of constraints come first, then those of regions, both in their order.
#ifndef VIEWER_MIRROR_DISTANCES_H
#define VIEWER_MIRROR_DISTANCES_H

#include "gl/gl.h"

#include <relume/world/object.h>

// Of one object.
struct mirror_fields {
    GLuint buffer, texture;  // of numbers
    bool made;
    unsigned of;  // relume_objects_info.reflections_set
    int count;    // 0: all distances are straight
};

// Zeroed it holds nothing.
struct mirror_distances {
    GLuint vertices, triangles;  // textures of buffers: the mesh
    struct mirror_fields *object;
    int objects;
    bool too_large;  // for this machine: distances are straight
};

// Units of samplerBuffer `along`, `vertices` and usamplerBuffer `triangles`.
struct mirror_units {
    int along, vertices, triangles;
};

// The number of a field, -1: distances are straight.
int mirror_field_of_constraint(const relume_reflection *reflection, int constraint);
int mirror_field_of_region(const relume_reflection *reflection, int region);

// Make the fields of an object those that shaders read; `*count` is how many there are. `vertices`
// and `triangles` are buffers of the mesh. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status mirror_distances_use(int *count, struct mirror_distances *distances,
                                   const struct gl *gl, const relume_objects *objects, int object,
                                   GLuint vertices, GLuint triangles,
                                   const struct mirror_units *units, const struct relume_log *log);
void mirror_distances_forget(struct mirror_distances *distances, const struct gl *gl);

#endif
