#version 330 core
// One cell of one of several slabs by depth, times the slab's weight, and the weight.
#include "footprint.glsl"
#include "slab_depth.glsl"
#include "slabs_ray.glsl"
uniform vec2 range;  // farthest and nearest disparity
out vec4 color;

void main()
{
    vec2 at = (gl_FragCoord.xy - picture.xy) / (picture.zw - picture.xy);
    vec2 uv, hit;
    if (!slabs_ray(uv, hit, eye, direction_at(at)) || !in_cell(uv, cell) ||
        slab_weight(uv, hit, st) <= 0.0)
        discard;
    vec2 texels = slabs_texels(hit, at, vec2(textureSize(view00, 0)) / (st.zw - st.xy));
    Footprint across = footprint_of(texels.x);
    Footprint down = footprint_of(texels.y);
    color = vec4(0.0);
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++) {
            vec2 within = vec2(footprint_place(across, i), footprint_place(down, j));
            if (!slabs_ray(uv, hit, eye, direction_at(at + within / (picture.zw - picture.xy))))
                continue;
            vec2 place = (hit - st.xy) / (st.zw - st.xy);
            find_cameras(uv, vec2(place.x, 1.0 - place.y));
            vec4 value = shade(range.y, range.x);
            color += slab_weight(uv, hit, st) * value.a * vec4(value.rgb, 1.0);
        }
    color /= float(across.count * down.count);
}
