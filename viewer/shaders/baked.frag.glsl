#version 330 core
// What a baked object shows under the lights of its colours. Twin: look_up in src/world/baked/lit.c.
uniform sampler2D place, normal_s, tangent_t;  // of the surface
uniform usamplerBuffer clusters;  // [blocks][texels]
uniform samplerBuffer weights;    // [blocks][texels][components]
uniform samplerBuffer frames;     // normal and tangent of each texel
uniform samplerBuffer colours;    // [blocks][clusters][1 + components][views]
uniform int part;
uniform vec4 eye;      // its place, 1; or the direction towards it, 0
uniform vec3 axes[3];  // of the object in the world
uniform ivec2 atlas;   // texels
uniform vec3 counts;   // views along a side of the map, clusters, components
uniform ivec2 blocks;  // and views in each
layout(location = 0) out vec4 colour;
const float LOWEST = 1e-3;
const uint NONE = 65535u;

vec3 show_view(int texel, int view)
{
    bool own = blocks.x > 1;
    int components = int(counts.z), block = own ? view : 0;
    int at = block * atlas.x * atlas.y + texel;
    int first = (block * int(counts.y) + int(texelFetch(clusters, at).x)) * (1 + components) *
                    blocks.y + (own ? 0 : view);
    vec3 sum = texelFetch(colours, first).rgb;
    for (int i = 0; i < components; i++)
        sum += texelFetch(weights, at * components + i).x *
               texelFetch(colours, first + (i + 1) * blocks.y).rgb;
    return sum;
}

vec3 show_texel(int texel, vec3 view)
{
    int side = int(counts.x);
    if (side == 1)
        return show_view(texel, 0);
    vec3 normal = texelFetch(frames, 2 * texel).xyz, tangent = texelFetch(frames, 2 * texel + 1).xyz;
    vec3 v = vec3(dot(view, tangent), dot(view, cross(normal, tangent)), dot(view, normal));
    float across = length(v.xy), z = max(v.z, LOWEST);
    if (v.z < LOWEST && across > 0.0)
        v.xy /= across;
    vec2 at = (v.xy / (1.0 + z) + 1.0) * 0.5 * float(side - 1);
    ivec2 low = min(ivec2(floor(at)), ivec2(side - 2));
    vec2 f = at - vec2(low);
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 4; k++) {
        ivec2 step = ivec2(k % 2, k / 2);
        vec2 share = mix(1.0 - f, f, vec2(step));
        if (share.x * share.y > 0.0)
            sum += share.x * share.y * show_view(texel, (low.y + step.y) * side + low.x + step.x);
    }
    return sum;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 at = texelFetch(place, pixel, 0);
    if (int(abs(at.w)) != part + 1)
        discard;
    vec2 texture_place =
        vec2(texelFetch(normal_s, pixel, 0).w, texelFetch(tangent_t, pixel, 0).w);
    vec3 towards = normalize(eye.xyz - eye.w * at.xyz);
    vec3 view = vec3(dot(towards, axes[0]), dot(towards, axes[1]), dot(towards, axes[2]));
    vec2 xy = clamp(texture_place * vec2(atlas) - 0.5, vec2(0.0), vec2(atlas - 1));
    ivec2 low = ivec2(floor(xy));
    vec2 f = xy - vec2(low);
    vec3 sum = vec3(0.0);
    float all = 0.0;
    for (int k = 0; k < 4; k++) {
        ivec2 step = ivec2(k % 2, k / 2);
        vec2 share = mix(1.0 - f, f, vec2(step));
        int texel = (low.y + step.y) * atlas.x + low.x + step.x;
        if (!(share.x * share.y > 0.0) || texelFetch(clusters, texel).x == NONE)
            continue;
        sum += share.x * share.y * show_texel(texel, view);
        all += share.x * share.y;
    }
    colour = vec4(all > 0.0 ? max(sum / all, 0.0) : vec3(0.0), 0.0);
}
