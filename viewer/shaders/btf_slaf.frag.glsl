#version 330 core
// Lafortune lobes and a factor for each view. Twin: model_laf.c.
const bool view_grid = true, light_grid = false;
#include "texels.glsl"
#include "cube.glsl"
#include "light.glsl"
#include "shadow.glsl"
#include "btf.glsl"

#include "btf_lafortune.glsl"
uniform samplerBuffer array3;  // factor [texels][views]

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    return laf_eval(texel, v, l) * texelFetch(array3, texel * counts.x + view).r;
}
