#version 330 core
// One cell of one of several slabs by depth, times the slab's weight, and the weight.
#include "footprint.glsl"
#include "slab_depth.glsl"
#include "slabs_ray.glsl"
#include "slab_depth_beside.glsl"
uniform vec2 range;   // farthest and nearest disparity
uniform vec2 extent;  // also of what lies behind the eye
out vec4 color;

vec4 value_passing(vec2 uv, vec2 hit)
{
    vec2 place = (hit - st.xy) / (st.zw - st.xy);
    find_cameras(uv, uv, vec2(place.x, 1.0 - place.y));
    vec4 value = shade(range.y, range.x);
    return slab_weight(uv, hit, st) * value.a * vec4(value.rgb, 1.0);
}

vec4 value_at(vec2 at)
{
    vec2 uv, hit;
    if (!beside)
        return slabs_ray(uv, hit, eye, direction_at(at)) ? value_passing(uv, hit) : vec4(0.0);
    Beside ray = slab_ray_beside(direction_at(at), st);
    if (!(ray.weight > 0.0))
        return vec4(0.0);
    vec4 value = slab_depth_beside(ray, extent);
    return ray.weight * value.a * vec4(value.rgb, 1.0);
}

void main()
{
    vec2 at = (gl_FragCoord.xy - picture.xy) / (picture.zw - picture.xy);
    vec2 uv, hit;
    if (!slabs_begin(uv, hit, at, st, cell))
        discard;
    color = UNSEEN;
    if (!beside && slab_weight(uv, hit, st) <= 0.0)
        return;
    vec2 texels = slabs_texels(hit, at, vec2(textureSize(view00, 0)) / (st.zw - st.xy));
    Footprint across = footprint_of(texels.x);
    Footprint down = footprint_of(texels.y);
    color = vec4(0.0);
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++) {
            vec2 within = vec2(footprint_place(across, i), footprint_place(down, j));
            color += value_at(at + within / (picture.zw - picture.xy));
        }
    color /= float(across.count * down.count);
}
