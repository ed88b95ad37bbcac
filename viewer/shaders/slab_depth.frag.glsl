#version 330 core
// One cell of a light slab between four cameras, each where it sees the surface of the ray.
#include "slab_window.glsl"
#include "slab_depth.glsl"
uniform vec2 range;  // farthest and nearest disparity
uniform float exposure;
out vec4 color;

vec4 value_at(vec2 within)
{
    vec2 at = window_place(within), uv = slab_uv(at, st);
    find_cameras(uv, uv, at);
    return shade(range.y, range.x);
}

void main()
{
    vec2 texels = view_size() / (picture.zw - picture.xy);
    color = vec4(exposure * footprint_mean(texels).rgb, 1.0);
}
