// objects_drawer_parts.h - what the files of the objects drawer share
#ifndef VIEWER_OBJECTS_DRAWER_PARTS_H
#define VIEWER_OBJECTS_DRAWER_PARTS_H

#include "draw/objects_drawer_state.h"

// Uniforms of the programs of models.
enum {
    ARRAYS = DRAW_OWN,
    MESHES = ARRAYS + BTF_ARRAYS,
    PLACE = MESHES + BTF_MESHES,
    NORMAL,
    TANGENT,
    FOOTPRINT,
    PICTURE,
    PART,
    EYE,
    TEXELS,
    FINEST,
    LEVEL,
    LEVELS,
    BILINEAR,
    WITHOUT_COSINE,
    COUNTS,
    AREA,
    MAP,
    MAP_TEXELS,
    SKY,
    SKY_TURN,
    SKY_RGB,
    SKY_TABLE,
    SOME_LIGHTS,
    RELIEF,
    SIDE,
    LIGHT,
    SHADOW = LIGHT + LIGHT_UNIFORMS,
    BTF_COUNT = SHADOW + SHADOW_UNIFORMS
};

// Of the programs that draw the surface.
enum {
    SURFACE_CLIP,
    SURFACE_PART,
    SURFACE_FIRST,
    SURFACE_SKIN,
    SURFACE_COVER,
    SURFACE_CUTOFF,
    SURFACE_SENDS,
    SURFACE_COUNT
};

// What is drawn: vertices and triangles; all else is that of the objects.
static inline const struct relume_objects_info *objects_drawer_drawn(const struct objects_drawer *t)
{
    return relume_objects_info(t->seen ? t->seen : t->objects);
}

// object_skins.c: RELUME_ENOMEM, RELUME_ESYSTEM.
relume_status objects_drawer_upload_skins(struct objects_drawer *t);
void objects_drawer_forget_skins(struct objects_drawer *t);
// For the program in use.
void objects_drawer_use_skin(const struct objects_drawer *t, const struct program *program,
                             int part);

// The shadow map of a light sample; it takes over the target.
void objects_drawer_draw_shadow(struct objects_drawer *t, int light_sample);
void objects_drawer_draw_whole(const struct gl *gl, const struct program *program,
                               const struct frame_area *area);
// A light sample as a light: a patch is an area light's piece, its normal the axis.
struct relume_light objects_drawer_light_of(const struct relume_object_light *light_sample);
// What a part shows of an environment, into the target in use.
relume_status objects_drawer_shade_sky(struct objects_drawer *t, int part, int material,
                                       const struct relume_light *light);

// object_sky.c
relume_status objects_drawer_create_sky(struct objects_drawer *t);
// What an environment shows on the surface where nothing hides it, into t->shown.
relume_status objects_drawer_show_sky(struct objects_drawer *t, const struct relume_light *light,
                                      int only);
// Light number `number`, an environment, onto what is shaded.
relume_status objects_drawer_add_sky(struct objects_drawer *t, int number, int only);

#endif
