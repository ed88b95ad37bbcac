#version 330 core
// A lit texture. Twin: model_lit.c.
const bool view_grid = false, light_grid = false;
#include "texels.glsl"
#include "cube.glsl"
#include "light.glsl"
#include "shadow.glsl"
#include "btf.glsl"

uniform samplerBuffer array0;  // texture [texels]

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    return texelFetch(array0, texel).rgb * (without_cosine ? 1.0 : l.z);
}
