#version 330 core
// What a baked object shows under the lights of its colours.
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
const uint NONE = 65535u;
int side;

#include "shared/baked.glsl"

bool find_texel(ivec2 texel)
{
    return texelFetch(clusters, texel.y * atlas.x + texel.x).x != NONE;
}

void texel_frame(out vec3 normal, out vec3 tangent, ivec2 texel)
{
    int index = texel.y * atlas.x + texel.x;
    normal = texelFetch(frames, 2 * index).xyz;
    tangent = texelFetch(frames, 2 * index + 1).xyz;
}

vec3 show_view(ivec2 texel, int view)
{
    bool own = blocks.x > 1;
    int components = int(counts.z), block = own ? view : 0;
    int at = (block * atlas.y + texel.y) * atlas.x + texel.x;
    int first = (block * int(counts.y) + int(texelFetch(clusters, at).x)) * (1 + components) *
                    blocks.y + (own ? 0 : view);
    vec3 sum = texelFetch(colours, first).rgb;
    for (int i = 0; i < components; i++)
        sum += texelFetch(weights, at * components + i).x *
               texelFetch(colours, first + (i + 1) * blocks.y).rgb;
    return sum;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 at = texelFetch(place, pixel, 0);
    if (int(abs(at.w)) != part + 1)
        discard;
    side = int(counts.x);
    vec2 texture_place =
        vec2(texelFetch(normal_s, pixel, 0).w, texelFetch(tangent_t, pixel, 0).w);
    vec3 towards = normalize(eye.xyz - eye.w * at.xyz);
    vec3 view = vec3(dot(towards, axes[0]), dot(towards, axes[1]), dot(towards, axes[2]));
    colour = vec4(baked_value(texture_place, atlas, view), 0.0);
}
