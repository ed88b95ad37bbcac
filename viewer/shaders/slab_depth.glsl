// The cell of a slab by depth: its views and disparities have textures of their own.
uniform sampler2D view00;  // low u, low v
uniform sampler2D view10;  // high u, low v
uniform sampler2D view01;
uniform sampler2D view11;
uniform sampler2D disparity00;
uniform sampler2D disparity10;
uniform sampler2D disparity01;
uniform sampler2D disparity11;
#include "slab_parts.glsl"
uniform vec4 here;
int rounds = 2;
float slope = 0.0;
#include "shared/slab_depth.glsl"
const float GUESSED = 1e-3;

vec4 part_texel(sampler2D view, ivec2 at)
{
    return texelFetch(view, clamp(at, ivec2(0), textureSize(view, 0) - 1), 0);
}

float disparity_texel(int c, ivec2 at)
{
    if (c == 0)
        return part_texel(disparity00, at - ivec2(first_low.xy)).r;
    if (c == 1)
        return part_texel(disparity10, at - ivec2(first_low.zw)).r;
    if (c == 2)
        return part_texel(disparity01, at - ivec2(first_high.xy)).r;
    return part_texel(disparity11, at - ivec2(first_high.zw)).r;
}

vec4 view_texel(int c, ivec2 at)
{
    if (c == 0)
        return part_texel(view00, at - ivec2(first_low.xy));
    if (c == 1)
        return part_texel(view10, at - ivec2(first_low.zw));
    if (c == 2)
        return part_texel(view01, at - ivec2(first_high.xy));
    return part_texel(view11, at - ivec2(first_high.zw));
}

// The colour of a ray, and how sure it is.
vec4 shade(float nearest, float farthest)
{
    Sum sum;
    bool seen = gather_ray(sum, nearest, farthest);
    vec3 rgb = sum.weight > 0.0 ? sum.value.rgb / sum.weight : vec3(0.0);
    return vec4(rgb, seen ? sum.weight : GUESSED * sum.weight);
}
