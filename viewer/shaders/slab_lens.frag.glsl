#version 330 core
// What one camera adds to a frame through an aperture, and its weight. Twin:
// src/relight/view/slab_lens.c.
#include "slab_window.glsl"
#include "texels.glsl"
#include "shared/slab_lens.glsl"
uniform sampler2D view;
uniform vec4 st;    // st_min, st_max
uniform vec4 grid;  // first and last lines of the cameras: low u, low v, high u, high v
uniform vec2 lens;  // radius, disparity of the plane in focus
out vec4 color;

// And the weight; rays beside the grid are those of its border.
vec4 value_at(vec2 within)
{
    vec2 at = window_place(within), uv = slab_uv(at, st);
    vec2 size = vec2(textureSize(view, 0));
    vec2 shift = (uv - camera) / (st.zw - st.xy) * size * vec2(1.0, -1.0);
    vec2 position = at * size + lens.y * shift;
    bool seen = all(greaterThanEqual(position, vec2(0.0))) && all(lessThanEqual(position, size));
    float weight = seen ? slab_lens_weight(clamp(uv, grid.xy, grid.zw), lens.x) : 0.0;
    return weight * vec4(texels_bilinear(view, position), 1.0);
}

void main()
{
    vec2 texels = vec2(textureSize(view, 0)) / (picture.zw - picture.xy);
    color = footprint_mean(texels);
}
