#version 330 core
// A colour for each texel times n.l. Twin: model_lit.c.
#define LOBES
const bool view_grid = false, light_grid = false;
#include "btf/btf.glsl"

uniform samplerBuffer array0;  // texture [texels]

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    return texelFetch(array0, texel).rgb * (without_cosine ? 1.0 : l.z);
}

#ifdef SKY
vec3 model_lit(int texel, int view, vec3 v, mat3 frame)
{
    return texelFetch(array0, texel).rgb * sky_even(frame, true);
}
#endif
