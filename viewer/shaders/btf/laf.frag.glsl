#version 330 core
// Lafortune lobes for each texel. Twin: model_laf.c.
#define LOBES
const bool view_grid = false, light_grid = false;
#include "btf/btf.glsl"
#include "btf/lafortune.glsl"

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    return laf_eval(texel, v, l);
}

#ifdef SKY
vec3 model_lit(int texel, int view, vec3 v, mat3 frame)
{
    return laf_lit(texel, v, frame);
}
#endif
