#version 330 core
// One cell of one of several slabs: the quadralinear basis, times the slab's weight, and the weight.
#include "slab_cell.glsl"
#include "slabs_main.glsl"

const float LEAST_FLAT = 1.4;

vec3 flat_value(vec2 uv, vec2 hit)
{
    vec2 at = (hit - st.xy) / (st.zw - st.xy);
    return cell_value(uv, vec2(at.x, 1.0 - at.y));
}

// What the slab says of a ray, and its weight.
vec4 ray_value(vec2 at)
{
    vec2 uv, hit;
    bool ahead = slabs_ray(uv, hit, eye, direction_at(at));
    if (!beside)
        return ahead ? slab_weight(uv, hit, st) * vec4(flat_value(uv, hit), 1.0) : vec4(0.0);
    Beside ray = slab_ray_beside(direction_at(at), st);
    bool within = all(greaterThanEqual(hit, st.xy)) && all(lessThanEqual(hit, st.zw));
    return ahead && within && ray.weight > LEAST_FLAT ? ray.weight * vec4(flat_value(ray.at, hit), 1.0) : vec4(0.0);
}
