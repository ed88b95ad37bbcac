// A pixel of a baked object: four texels of its atlas, each in four views of a map. Twin: look_up
// of src/world/baked/lit.c.
//
// The shader declares `side`, the views along a side of the map, and defines:
bool find_texel(ivec2 texel);           // whether the atlas holds a texel
vec3 show_view(ivec2 texel, int view);  // a texel that was found, in a view
void texel_frame(out vec3 normal, out vec3 tangent, ivec2 texel);

// Twin: view_place.
vec2 view_place(vec3 v)
{
    const float LOWEST = 1e-3;
    float across = length(v.xy), z = max(v.z, LOWEST);
    vec2 level = v.z < LOWEST && across > 0.0 ? v.xy / across : v.xy;
    return (clamp(level / (1.0 + z), -1.0, 1.0) + 1.0) * 0.5 * float(side - 1);
}

// The share of number k of four neighbours.
float corner_share(vec2 part, int k)
{
    vec2 share = mix(1.0 - part, part, vec2(k % 2, k / 2));
    return share.x * share.y;
}

vec3 show_texel(ivec2 texel, vec3 towards)
{
    if (side == 1)
        return show_view(texel, 0);
    vec3 normal, tangent, sum = vec3(0.0);
    texel_frame(normal, tangent, texel);
    vec2 at = view_place(vec3(dot(towards, tangent), dot(towards, cross(normal, tangent)),
                              dot(towards, normal)));
    ivec2 low = min(ivec2(floor(at)), side - 2);
    for (int k = 0; k < 4; k++) {
        float share = corner_share(at - vec2(low), k);
        if (share > 0.0)
            sum += share * show_view(texel, (low.y + k / 2) * side + low.x + k % 2);
    }
    return sum;
}

// `place`: 0 to 1 in the atlas of `size` texels; `towards`: the eye, from the object.
vec3 baked_value(vec2 place, ivec2 size, vec3 towards)
{
    vec2 at = clamp(place * vec2(size) - 0.5, vec2(0.0), vec2(size - 1));
    ivec2 low = ivec2(floor(at));
    vec3 sum = vec3(0.0);
    float all = 0.0;
    for (int k = 0; k < 4; k++) {
        float share = corner_share(at - vec2(low), k);
        ivec2 texel = min(low + ivec2(k % 2, k / 2), size - 1);
        if (!(share > 0.0) || !find_texel(texel))
            continue;
        sum += share * show_texel(texel, towards);
        all += share;
    }
    return all > 0.0 ? max(sum / all, 0.0) : vec3(0.0);
}
