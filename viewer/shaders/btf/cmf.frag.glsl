#version 330 core
// Products of factors of view, light, half vector and difference. Twin: model_cmf.c.
#define OWN_BLEND
const bool view_grid = true, light_grid = true;
#include "btf/btf.glsl"
#include "btf/upright.glsl"

uniform samplerBuffer array0;   // factor [clusters][views + lights + 2 * CELLS_OF_MAP]
uniform usamplerBuffer array1;  // cluster [texels]
const int SIDE = 15, CELLS_OF_MAP = SIDE * SIDE;

// Bilinear in the x and y of a unit vector.
vec3 map_at(int first, vec3 d)
{
    vec2 at = clamp(0.5 * (d.xy + 1.0), 0.0, 1.0) * float(SIDE - 1);
    ivec2 cell = min(ivec2(at), SIDE - 2);
    vec2 part_of = at - vec2(cell);
    int i = first + cell.y * SIDE + cell.x;
    return mix(mix(texelFetch(array0, i).rgb, texelFetch(array0, i + 1).rgb, part_of.x),
               mix(texelFetch(array0, i + SIDE).rgb, texelFetch(array0, i + SIDE + 1).rgb,
                   part_of.x),
               part_of.y);
}

// The maps are of the directions themselves, so that views and lights are blended apart.
vec3 model_blend(int texel, Blend v, Blend l)
{
    int first = int(texelFetch(array1, texel).r) * (counts.x + counts.y + 2 * CELLS_OF_MAP);
    int maps = first + counts.x + counts.y;
    vec3 h = normalize(v.direction + l.direction), by_view = vec3(0.0), by_light = vec3(0.0);
    for (int i = 0; i < 3; i++) {
        by_view += v.weight[i] * texelFetch(array0, first + v.index[i]).rgb;
        by_light += l.weight[i] * texelFetch(array0, first + counts.x + l.index[i]).rgb;
    }
    return by_view * by_light * map_at(maps, h) *
           map_at(maps + CELLS_OF_MAP, upright(l.direction, h));
}
