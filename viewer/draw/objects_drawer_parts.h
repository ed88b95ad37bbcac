// objects_drawer_parts.h - what the files of the objects drawer share
#ifndef VIEWER_OBJECTS_DRAWER_PARTS_H
#define VIEWER_OBJECTS_DRAWER_PARTS_H

#include "draw/objects_drawer_state.h"

// What the present frame draws.
static inline struct object_parts objects_drawer_parts(const struct objects_drawer *t)
{
    return (struct object_parts){t->objects, &t->mesh, &t->skins, t->only};
}

// Draws the shadow map of a light sample; it takes over the target.
static inline void objects_drawer_draw_shadow(struct objects_drawer *t, int light_sample)
{
    const struct object_parts parts = objects_drawer_parts(t);
    object_shadows_draw(&t->shadows, &parts, &t->lights.sample[light_sample]);
}

// What a part shows of an environment, into the target in use.
relume_status objects_drawer_shade_sky(struct objects_drawer *t, int part, int material,
                                       const struct relume_light *light);

// object_sky.c. RELUME_ESYSTEM.
relume_status object_sky_create(struct object_sky *s, const struct gl *gl,
                                const struct relume_log *log);
void object_sky_destroy(struct object_sky *s, const struct gl *gl);
// Makes the targets of a surface of width x height. RELUME_ESYSTEM.
relume_status object_sky_need(struct object_sky *s, const struct gl *gl, int width, int height,
                              const struct relume_log *log);
// What an environment shows on the surface where nothing hides it, into t->sky.shown.
relume_status objects_drawer_show_sky(struct objects_drawer *t, const struct relume_light *light);
// Adds light number `number`, an environment, to what is shaded.
relume_status objects_drawer_add_sky(struct objects_drawer *t, int number);

#endif
