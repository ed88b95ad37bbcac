#version 430
// What leaves send under a light: of the scene what its pixels show, and the part of it that
// objects leave; of objects what lamps bring and what they have gathered. Twins: light_point,
// light_leaves of world/transport/micro.c.
layout(local_size_x = 64) in;
#include "transport/tree.glsl"
struct Leaf {
    vec3 returned;  // of even light
    int node;
    vec3 emitted;
    int begins;     // of the scene: the first of its blocks; they end where the next one's begin
};
struct Block {
    uint number;
    float weight;
};
layout(std430, binding = 1) writeonly buffer Sents { Sent sent[]; };
layout(std430, binding = 2) readonly buffer Leaves { Leaf leaf[]; };
layout(std430, binding = 3) readonly buffer Blocks { Block block[]; };
uniform sampler2D panorama, mean;          // the scene under the light; one texel
uniform sampler2D let_without, let_with;   // lamps.frag, of leaves
uniform sampler2D gathered;                // by leaves
uniform ivec2 range;                       // first leaf, and behind the last
uniform int of_scene;                      // so many of all
uniform ivec2 layout_of;                   // blocks in a row, their side in pixels
uniform vec4 ball;                         // about the objects
uniform float sends, returns;              // of what leaves send of their own; of what they return

float sum_of(vec3 rgb)
{
    return rgb.r + rgb.g + rgb.b;
}

vec3 block_mean(int number)
{
    ivec2 from = ivec2(number % layout_of.x, number / layout_of.x) * layout_of.y;
    vec3 sum = vec3(0.0);
    for (int y = 0; y < layout_of.y; y++)
        for (int x = 0; x < layout_of.y; x++)
            sum += texelFetch(panorama, from + ivec2(x, y), 0).rgb;
    sum /= float(layout_of.y * layout_of.y);
    return any(isnan(sum)) || any(isinf(sum)) ? vec3(0.0) : max(sum, 0.0);
}

void main()
{
    int i = range.x + int(gl_GlobalInvocationID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x * 64u);
    if (i >= range.y)
        return;
    int width = textureSize(let_with, 0).x;
    ivec2 at = ivec2(i % width, i / width);
    vec3 left = texelFetch(let_with, at, 0).rgb, own = vec3(0.0);
    if (i >= of_scene) {
        own = returns * leaf[i].returned * (left + texelFetch(gathered, at, 0).rgb) + sends * leaf[i].emitted;
        own = max(own, 0.0);
        sent[leaf[i].node] = Sent(vec4(vec3(0.0), sum_of(own) * node[leaf[i].node].area), vec4(own, 1.0));
        return;
    }
    for (int k = leaf[i].begins; k < leaf[i + 1].begins; k++)
        own += block[k].weight * block_mean(int(block[k].number));
    float rest = sum_of(texelFetch(mean, ivec2(0), 0).rgb);
    float before = rest + sum_of(texelFetch(let_without, at, 0).rgb), after = rest + sum_of(left);
    float part = before > 0.0 ? after / before : 1.0;
    vec3 to = node[leaf[i].node].ball.xyz - ball.xyz;
    float arrives = sum_of(own) * node[leaf[i].node].area / (dot(to, to) + ball.w * ball.w);
    sent[leaf[i].node] = Sent(vec4(own, arrives), vec4(part * own, 1.0));
}
