#version 330 core
// Principal components within clusters of texels. Twin: model_lpca.c.
#define OWN_BLEND
const bool view_grid = true, light_grid = true;
#include "btf/btf.glsl"
#include "btf/pairs.glsl"

uniform samplerBuffer array0;   // mean [clusters][views][lights]
uniform samplerBuffer array1;   // pattern [clusters][components][views][lights]
uniform samplerBuffer array2;   // weight [texels][components]
uniform usamplerBuffer array3;  // cluster [texels]

vec3 model_blend(int texel, Blend v, Blend l)
{
    int cluster = int(texelFetch(array3, texel).r), pairs = counts.x * counts.y;
    vec3 rgb = blended(array0, cluster * pairs, v, l);
    for (int k = 0; k < counts.z; k++)
        rgb += texelFetch(array2, texel * counts.z + k).r *
               blended(array1, (cluster * counts.z + k) * pairs, v, l);
    return rgb;
}
