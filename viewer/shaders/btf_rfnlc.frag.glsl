#version 330 core
// The same for clusters of texels. Twin: model_rfnlc.c.
const bool view_grid = true, light_grid = false;
#include "texels.glsl"
#include "cube.glsl"
#include "light.glsl"
#include "shadow.glsl"
#include "btf.glsl"

#include "btf_fields.glsl"
uniform usamplerBuffer array3;  // cluster [texels]

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    return fields_eval(int(texelFetch(array3, texel).r), view, l);
}
