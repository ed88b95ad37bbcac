#version 330 core
// Cosine lobes of the light for each view. Twin: model_rfnl.c.
const bool view_grid = true, light_grid = false;
#include "texels.glsl"
#include "cube.glsl"
#include "light.glsl"
#include "shadow.glsl"
#include "btf.glsl"

#include "btf_fields.glsl"

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    return fields_eval(texel, view, l);
}
