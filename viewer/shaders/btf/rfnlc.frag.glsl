#version 330 core
// The same for clusters of texels. Twin: model_rfnlc.c.
#define LOBES
const bool view_grid = true, light_grid = false;
#include "btf/btf.glsl"
#include "btf/fields.glsl"
uniform usamplerBuffer array3;  // cluster [texels]

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    return fields_eval(int(texelFetch(array3, texel).r), view, l);
}

#ifdef SKY
vec3 model_lit(int texel, int view, vec3 v, mat3 frame)
{
    return fields_lit(int(texelFetch(array3, texel).r), view, frame);
}
#endif
