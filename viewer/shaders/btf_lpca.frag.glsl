#version 330 core
// Principal components within clusters of texels. Twin: model_lpca.c.
const bool view_grid = true, light_grid = true;
#include "texels.glsl"
#include "cube.glsl"
#include "light.glsl"
#include "shadow.glsl"
#include "btf.glsl"

uniform samplerBuffer array0;   // mean [clusters][views][lights]
uniform samplerBuffer array1;   // pattern [clusters][components][views][lights]
uniform samplerBuffer array2;   // weight [texels][components]
uniform usamplerBuffer array3;  // cluster [texels]

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    int cluster = int(texelFetch(array3, texel).r);
    int pairs = counts.x * counts.y, pair = view * counts.y + light;
    vec3 rgb = texelFetch(array0, cluster * pairs + pair).rgb;
    for (int k = 0; k < counts.z; k++)
        rgb += texelFetch(array2, texel * counts.z + k).r *
               texelFetch(array1, (cluster * counts.z + k) * pairs + pair).rgb;
    return rgb;
}
