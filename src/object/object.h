// object.h - the inside of relume_objects
#ifndef OBJECT_OBJECT_H
#define OBJECT_OBJECT_H

#include "scene/trace.h"

#include <relume/object.h>

struct relume_objects {
    struct relume_objects_info info;  // points to what is below
    struct mesh mesh;  // the same triangles for rays; their material is the number of the part
    tracer *tracer;
    struct relume_object_vertex *vertices;
    uint32_t (*triangles)[3];
    struct relume_object_part *part;  // [parts]
    struct relume_object_material *material;
    char **folder;  // [materials]: as it was opened
};

// The part's material, opened when it is not there yet; its number. RELUME_EDATA, RELUME_ENOMEM.
relume_status objects_material(relume_objects *o, const char *folder, int *number,
                               const struct relume_objects_params *params);

// How a mesh stands and how its parts are covered.
struct covering {
    const char *part;  // NULL: all others
    int material;
    double repeat[2], offset[2];
    bool nearest;
    bool used;
};
struct standing {
    struct frame frame;
    struct covering *covering;
    int coverings;
};
// Add a mesh file. RELUME_EDATA, RELUME_ENOMEM.
relume_status objects_add(relume_objects *o, const char *path, struct standing *standing,
                          const struct relume_objects_params *params);
// Tangents, and what rays need. RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status objects_finish(relume_objects *o, const struct relume_objects_params *params);

// ---------------------------------------------------------------- rays

// Where a ray meets the objects.
struct surface_point {
    double distance;
    vec3 position;
    vec3 geometric;  // the normal of the triangle, towards the ray's origin
    vec3 lifted;     // the position where shadow rays start
    vec3 normal, tangent, bitangent;
    double s, t;
    int part;
};
bool objects_hit(struct surface_point *out, const relume_objects *o, vec3 origin, vec3 direction);
// Whether nothing lies between a point of a surface and what shines `towards` it from `distance`
// away. `normal` may be zero: the point is not the objects'.
bool objects_reached(const relume_objects *o, vec3 point, vec3 normal, vec3 towards,
                     double distance);
// What the point shows of all lamps.
void objects_shade(float rgb[3], const relume_objects *o, const struct surface_point *point,
                   vec3 towards_eye, const struct relume_lamp *lamps, int n, bool no_shadows);

// Pixels of a picture over several cores: `value` is called for places in pixels, centres at +0.5.
typedef void pixel_value(float rgb[3], const void *context, double x, double y);
relume_status objects_trace(struct relume_image *out, pixel_value *value, const void *context,
                            const struct relume_render_params *params);

#endif
