#version 330 core
// Full matrix factorisation. Twin: model_fmf.c.
const bool view_grid = true, light_grid = true;
#include "texels.glsl"
#include "cube.glsl"
#include "light.glsl"
#include "shadow.glsl"
#include "btf.glsl"

uniform samplerBuffer array0;  // weight [texels][components]
uniform samplerBuffer array1;  // pattern [components][views][lights]

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    int pairs = counts.x * counts.y, pair = view * counts.y + light;
    vec3 rgb = vec3(0.0);
    for (int k = 0; k < counts.z; k++)
        rgb += texelFetch(array0, texel * counts.z + k).r *
               texelFetch(array1, k * pairs + pair).rgb;
    return rgb;
}
