// model_uniforms.h - uniforms of the programs of models, in their order (object_materials.c)
#ifndef VIEWER_MODEL_UNIFORMS_H
#define VIEWER_MODEL_UNIFORMS_H

#include "draw/btf_upload.h"
#include "draw/draw.h"
#include "draw/shadow_map.h"
#include "relit/light_uniforms.h"

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

#endif
