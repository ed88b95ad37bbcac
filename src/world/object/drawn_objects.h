// drawn_objects.h - objects while a frame is drawn: lights on them, reflections, levels
#ifndef OBJECT_DRAWN_OBJECTS_H
#define OBJECT_DRAWN_OBJECTS_H

#include "relight/light/environment.h"
#include "world/reflect/reflection.h"

#include <relume/world/object.h>

// Show a part in another of the materials. RELUME_EINVAL when there is no such part or material.
relume_status relume_objects_choose(relume_objects *objects, int part, int material);

// The objects as they are drawn for an eye in `eye` that sees `pixel` at a distance of 1 under a
// pixel: parts whose description asks for levels of detail have the fewest triangles that are off
// by no more pixels than it says, closed where parts of an object meet, which move to the next
// level's as the eye does (relume_lod_choose; geomorphs, Hoppe 1996). Pictures do so themselves;
// this is for those who draw. `*shown` is NULL at first, later what the last call left: it stays
// where the eye sees the same, else it is another one, and NULL where all is shown in full, as for
// a `pixel` of 0. Parts and materials are numbered as in `objects`, which must outlive it; `rays`:
// it can be ray traced, too. It is for relume_objects_info, relume_objects_render and
// relume_objects_destroy alone. RELUME_ENOMEM, RELUME_ESYSTEM; then it is as before.
relume_status relume_objects_shown(relume_objects **shown, const relume_objects *objects,
                                   struct relume_vec3 eye, double pixel, bool rays);

// Edit the reflections of an object's mirrors from now on; NULL: as they are. Copied. Errors of
// relume_reflection_create; then all is as before.
relume_status relume_objects_set_reflections(relume_objects *objects, int object,
                                             const struct relume_reflection_edit *edit,
                                             const struct relume_reflection_params *params);
// How the reflections of an object are edited, until they are set again; NULL: as they are.
const relume_reflection *relume_objects_reflections(const relume_objects *objects, int object);
// Write all edits to such a file. What is there and is no such file stays, RELUME_EINVAL with a
// sentence. RELUME_EIO with a sentence, RELUME_ENOMEM.
relume_status relume_objects_save_reflections(const relume_objects *objects, const char *path,
                                              const struct relume_log *log);

// Where a ray from a mirror at `place` along the unit vector `direction` ends in a panorama, as
// mirrors show it; `places`: the position that each pixel of the panorama shows, of three channels.
// False where that is the far distance.
bool relume_objects_reflected_place(struct relume_vec3 *out, const struct relume_geometry *panorama,
                                    const struct relume_image *places, struct relume_vec3 place,
                                    struct relume_vec3 direction);

// A light as drawing takes it: from one direction at each point.
struct relume_object_light {
    bool is_patch;                    // of an area light: `patch`, not `light`, is what it sends
    bool is_sky;                      // of an environment: where it arrives, not what it shows
    int number;                       // of the light that it is of
    struct relume_light light;        // never area or environment
    struct relume_light_patch patch;  // of an area light
};

enum { RELUME_OBJECT_LIGHTS_MOST = 64 };  // of one light
// The lights as samples, `*n` of them: areas in as many patches as the objects' distance asks for,
// at most 36; environments in RELUME_OBJECT_LIGHTS_MOST directional lights
// (relume_environment_sample). Free `*out` with relume_free(). RELUME_ENOMEM;
// RELUME_EINVAL for a light that relume_light_check refuses.
relume_status relume_objects_lights(struct relume_object_light **out, int *n,
                                    const relume_objects *objects,
                                    const struct relume_light *lights, int count);
// What it sends to `point` and the unit direction towards it, as relume_light_at; `*distance` may
// be infinite.
bool relume_object_light_at(struct relume_vec3 *towards, float rgb[3], double *distance,
                            const struct relume_object_light *light_sample,
                            struct relume_vec3 point);

#endif
