#version 330 core
// Principal components of each view's pictures. Twin: model_vpca.c.
const bool view_grid = true, light_grid = true;
#include "texels.glsl"
#include "cube.glsl"
#include "light.glsl"
#include "shadow.glsl"
#include "btf.glsl"

uniform samplerBuffer array0;  // mean [views][texels]
uniform samplerBuffer array1;  // texture [views][components][texels]
uniform samplerBuffer array2;  // weight [views][lights][components]

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    int area = texels.x * texels.y, weight = (view * counts.y + light) * counts.z;
    vec3 rgb = texelFetch(array0, view * area + texel).rgb;
    for (int k = 0; k < counts.z; k++)
        rgb += texelFetch(array2, weight + k).r *
               texelFetch(array1, (view * counts.z + k) * area + texel).rgb;
    return rgb;
}
