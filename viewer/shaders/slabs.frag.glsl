#version 330 core
// One cell of one of several slabs: the quadralinear basis, times the slab's weight, and the weight.
#include "footprint.glsl"
#include "texels.glsl"
#include "slabs_ray.glsl"
uniform sampler2D view00;  // low u, low v
uniform sampler2D view10;  // high u, low v
uniform sampler2D view01;
uniform sampler2D view11;
uniform vec4 st;       // st_min, st_max
uniform vec4 cell;     // low u, low v, high u, high v
uniform bool nearest;  // the nearest camera instead
out vec4 color;

const float LEAST_FLAT = 1.4;

vec3 flat_value(vec2 uv, vec2 hit)
{
    vec2 part = clamp((uv - cell.xy) / max(cell.zw - cell.xy, vec2(1e-30)), 0.0, 1.0);
    if (nearest)
        part = step(0.5, part);
    vec2 place = (hit - st.xy) / (st.zw - st.xy);
    vec2 position = vec2(place.x, 1.0 - place.y) * vec2(textureSize(view00, 0));
    vec3 low = mix(texels_bilinear(view00, position), texels_bilinear(view10, position), part.x);
    vec3 high = mix(texels_bilinear(view01, position), texels_bilinear(view11, position), part.x);
    return mix(low, high, part.y);
}

// What the slab says of a ray, and its weight.
vec4 value_at(vec2 at)
{
    vec2 uv, hit;
    bool ahead = slabs_ray(uv, hit, eye, direction_at(at));
    if (!beside)
        return ahead ? slab_weight(uv, hit, st) * vec4(flat_value(uv, hit), 1.0) : vec4(0.0);
    Beside ray = slab_ray_beside(direction_at(at), st);
    bool within = all(greaterThanEqual(hit, st.xy)) && all(lessThanEqual(hit, st.zw));
    return ahead && within && ray.weight > LEAST_FLAT ? ray.weight * vec4(flat_value(ray.at, hit), 1.0) : vec4(0.0);
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
