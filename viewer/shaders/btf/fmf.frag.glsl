#version 330 core
// Full matrix factorisation. Twin: model_fmf.c.
#define OWN_BLEND
const bool view_grid = true, light_grid = true;
#include "btf/btf.glsl"
#include "btf/pairs.glsl"

uniform samplerBuffer array0;  // weight [texels][components]
uniform samplerBuffer array1;  // pattern [components][views][lights]

vec3 model_blend(int texel, Blend v, Blend l)
{
    int pairs = counts.x * counts.y;
    vec3 rgb = vec3(0.0);
    for (int k = 0; k < counts.z; k++)
        rgb += texelFetch(array0, texel * counts.z + k).r * blended(array1, k * pairs, v, l);
    return rgb;
}
