#version 330 core
// The measured values. Twin: relume_btf_evaluate.
const bool view_grid = true, light_grid = true;
#include "btf/btf.glsl"

uniform samplerBuffer array0;  // values [views][lights][texels]

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    return texelFetch(array0, (view * counts.y + light) * area + texel).rgb;
}
