#version 330 core
// Lafortune lobes for each texel. Twin: model_laf.c.
const bool view_grid = false, light_grid = false;
#include "texels.glsl"
#include "cube.glsl"
#include "light.glsl"
#include "shadow.glsl"
#include "btf.glsl"

#include "btf_lafortune.glsl"

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    return laf_eval(texel, v, l);
}
