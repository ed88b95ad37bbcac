#version 330 core
// Principal components of each view's pictures. Twin: model_vpca.c.
#define OWN_BLEND
const bool view_grid = true, light_grid = true;
#include "btf/btf.glsl"

uniform samplerBuffer array0;  // mean [views][texels]
uniform samplerBuffer array1;  // texture [views][components][texels]
uniform samplerBuffer array2;  // weight [views][lights][components]

// Weights of the three lights are blended first: the texel's textures are read once.
vec3 model_blend(int texel, Blend v, Blend l)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 3; i++) {
        int view = v.index[i];
        if (v.weight[i] == 0.0)
            continue;
        ivec3 weight = (view * counts.y + l.index) * counts.z;
        vec3 rgb = texelFetch(array0, view * area + texel).rgb;
        for (int k = 0; k < counts.z; k++) {
            float w = l.weight.x * texelFetch(array2, weight.x + k).r +
                      l.weight.y * texelFetch(array2, weight.y + k).r +
                      l.weight.z * texelFetch(array2, weight.z + k).r;
            rgb += w * texelFetch(array1, (view * counts.z + k) * area + texel).rgb;
        }
        sum += v.weight[i] * rgb;
    }
    return sum;
}
