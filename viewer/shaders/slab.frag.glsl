#version 330 core
// A cell of a light slab.
#include "slab_window.glsl"
#include "slab_cell.glsl"
uniform float exposure;
out vec4 color;

vec4 value_at(vec2 within)
{
    vec2 at = window_place(within);
    return vec4(cell_value(slab_uv(at, st), at), 1.0);
}

void main()
{
    vec2 texels = view_size() / (picture.zw - picture.xy);
    color = vec4(exposure * footprint_mean(texels).rgb, 1.0);
}
