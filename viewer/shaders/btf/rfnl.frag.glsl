#version 330 core
// Cosine lobes of the light for each view. Twin: model_rfnl.c.
#define LOBES
const bool view_grid = true, light_grid = false;
#include "btf/btf.glsl"
#include "btf/fields.glsl"

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    return fields_eval(texel, view, l);
}

#ifdef SKY
vec3 model_lit(int texel, int view, vec3 v, mat3 frame)
{
    return fields_lit(texel, view, frame);
}
#endif
