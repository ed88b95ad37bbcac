#version 330 core
// Lafortune lobes and a factor for each view. Twin: model_laf.c.
#define LOBES
const bool view_grid = true, light_grid = false;
#include "btf/btf.glsl"
#include "btf/lafortune.glsl"
uniform samplerBuffer array3;  // factor [texels][views]

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    return laf_eval(texel, v, l) * texelFetch(array3, texel * counts.x + view).r;
}

#ifdef SKY
vec3 model_lit(int texel, int view, vec3 v, mat3 frame)
{
    return laf_lit(texel, v, frame) * texelFetch(array3, texel * counts.x + view).r;
}
#endif
