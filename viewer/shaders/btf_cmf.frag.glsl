#version 330 core
// Products of factors of view, light, half and difference vector. Twin: model_cmf.c.
const bool view_grid = true, light_grid = true;
#include "texels.glsl"
#include "cube.glsl"
#include "light.glsl"
#include "shadow.glsl"
#include "btf.glsl"


uniform samplerBuffer array0;   // factor [clusters][views + lights + 2 maps]
uniform usamplerBuffer array1;  // cluster [texels]

const int SIDE = 15;  // of a map

// Bilinear in the x and y of a unit vector.
vec3 map_at(int first, vec3 d)
{
    vec2 at = clamp(0.5 * d.xy + 0.5, 0.0, 1.0) * float(SIDE - 1);
    vec2 cell = min(floor(at), float(SIDE - 2)), part_of = at - cell;
    int k = first + int(cell.y) * SIDE + int(cell.x);
    return mix(mix(texelFetch(array0, k).rgb, texelFetch(array0, k + 1).rgb, part_of.x),
               mix(texelFetch(array0, k + SIDE).rgb, texelFetch(array0, k + SIDE + 1).rgb,
                   part_of.x),
               part_of.y);
}

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    int entries = counts.x + counts.y + 2 * SIDE * SIDE;
    int first = int(texelFetch(array1, texel).r) * entries, maps = first + counts.x + counts.y;
    vec3 h = normalize(v + l);
    return texelFetch(array0, first + view).rgb *
           texelFetch(array0, first + counts.x + light).rgb * map_at(maps, h) *
           map_at(maps + SIDE * SIDE, upright(l, h));
}
