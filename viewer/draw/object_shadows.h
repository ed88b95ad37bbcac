// object_shadows.h - shadows that objects throw, on themselves and on the scene
#ifndef VIEWER_OBJECT_SHADOWS_H
#define VIEWER_OBJECT_SHADOWS_H

#include "draw/captured_mesh.h"
#include "draw/draw.h"
#include "draw/object_lights.h"
#include "draw/object_parts.h"
#include "draw/shadow_map.h"
#include "world/object/drawn_objects.h"

struct object_shadows {
    struct program depth, cast;
    struct shadow_map map;                 // of a light sample
    const struct captured_mesh *captured;  // that throws shadows on objects as well; NULL: none
    bool off;                              // nothing is in shadow
    struct relume_vec3 middle;             // ball about the objects
    double radius;
};

// For objects within the bounds of `info`. RELUME_ESYSTEM.
relume_status object_shadows_create(struct object_shadows *s, const struct gl *gl,
                                    const struct relume_objects_info *info,
                                    const struct relume_log *log);
void object_shadows_destroy(struct object_shadows *s, const struct gl *gl);
// Draws the shadow map of a light sample; it takes over the target.
void object_shadows_draw(struct object_shadows *s, const struct object_parts *parts,
                         const struct relume_object_light *sample);
// Sets the uniforms of shadow.glsl in the program in use, by way of texture unit `unit`.
void object_shadows_use(const struct object_shadows *s, const struct gl *gl, const GLint *at,
                        int unit);
// As objects_drawer_cast.
void object_shadows_cast(struct object_shadows *s, const struct object_parts *parts,
                         const struct object_lights *lights, int sample,
                         const struct frame_area *area, GLuint scene, const struct target *lone);

#endif
