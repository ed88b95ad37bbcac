// things_parts.h - what the files of things share
#ifndef VIEWER_THINGS_PARTS_H
#define VIEWER_THINGS_PARTS_H

#include "draw/things_state.h"

// Uniforms of the programs of models.
enum {
    ARRAYS = DRAW_OWN,
    DOMES = ARRAYS + BTF_ARRAYS,
    PLACE = DOMES + BTF_DOMES,
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
    LIGHT,
    SHADOW = LIGHT + SHINE_UNIFORMS,
    BTF_COUNT = SHADOW + SHADOW_UNIFORMS
};

// The shadow map of a lamp; it takes over the target.
void things_draw_shadow(struct things *t, int lamp);
void things_draw_whole(const struct gl *gl, const struct program *program,
                       const struct place *place);
// What a part shows of an environment, into the target in use.
relume_status things_shade_sky(struct things *t, int part, int material,
                               const struct relume_light *light);

// things_sky.c
relume_status things_create_sky(struct things *t);
// Light number `number`, an environment, onto what is shaded.
relume_status things_add_sky(struct things *t, int number, int only);

#endif
