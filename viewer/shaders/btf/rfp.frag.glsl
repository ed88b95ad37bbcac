#version 330 core
// A biquadratic polynomial of the light for each view. Twin: model_rfp.c.
const bool view_grid = true, light_grid = false;
#include "btf/btf.glsl"

uniform samplerBuffer array0;  // coefficient [texels][views][6]

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    float term[6] = float[6](l.x * l.x, l.y * l.y, l.x * l.y, l.x, l.y, 1.0);
    int at = (texel * counts.x + view) * 6;
    vec3 sum = vec3(0.0);
    for (int t = 0; t < 6; t++)
        sum += term[t] * texelFetch(array0, at + t).rgb;
    return sum;
}
