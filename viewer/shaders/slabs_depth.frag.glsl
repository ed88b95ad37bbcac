#version 330 core
// One cell of one of several slabs by depth, times the slab's weight, and the weight.
#include "slab_depth.glsl"
#include "slabs_ray.glsl"
uniform vec2 range;  // farthest and nearest disparity
out vec4 color;

void main()
{
    vec2 at = (gl_FragCoord.xy - picture.xy) / (picture.zw - picture.xy);
    vec2 uv, hit;
    if (!slabs_ray(uv, hit, eye, direction_at(at)) || !in_cell(uv, cell))
        discard;
    vec2 place = (hit - st.xy) / (st.zw - st.xy);
    find_cameras(uv, vec2(place.x, 1.0 - place.y));
    float weight = slab_weight(uv, hit, st);
    if (weight <= 0.0)
        discard;
    vec4 value = shade(range.y, range.x);
    color = weight * value.a * vec4(value.rgb, 1.0);
}
