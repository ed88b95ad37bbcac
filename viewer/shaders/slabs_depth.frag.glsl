#version 330 core
// One cell of one of several slabs by depth, times the slab's weight, and the weight.
#include "slab_depth.glsl"
#include "slabs_main.glsl"
#include "slab_depth_beside.glsl"
uniform vec2 range;   // farthest and nearest disparity
uniform vec2 extent;  // also of what lies behind the eye

vec4 value_passing(vec2 uv, vec2 hit)
{
    vec2 place = (hit - st.xy) / (st.zw - st.xy);
    find_cameras(uv, uv, vec2(place.x, 1.0 - place.y));
    vec4 value = shade(range.y, range.x);
    return slab_weight(uv, hit, st) * value.a * vec4(value.rgb, 1.0);
}

vec4 ray_value(vec2 at)
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
