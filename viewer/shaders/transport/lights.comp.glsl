#version 430
// Virtual lights are drawn by how bright leaves are, from the root down, in strata; or, `again`, send what
// their leaves do by now. Twins: virtual_of_scene, virtual_of_senders.
layout(local_size_x = 64) in;
#include "transport/tree.glsl"
#include "transport/virtual.glsl"
struct Texels {
    vec4 place, normal, without, with_objects;  // as virtual_fetch.glsl
};
layout(std430, binding = 1) readonly buffer Sents { Sent sent[]; };
layout(std430, binding = 2) buffer Lights { Texels light[]; };
uniform sampler2D place, facing;  // of leaves
uniform ivec2 root;               // of one tree, or of two; -1: there is none
uniform ivec2 leaf_of;            // the number of a leaf of each, less its node's
uniform ivec2 range;              // first light, and how many
uniform bool again;
uniform vec4 centre;              // the eye that captured the scene; how far off it depth may be wrong
uniform float off;                // where light of objects begins: off its surface

// The child in which `u` lies, which becomes the rest.
int choose(int first, inout float u)
{
    int chosen = -1;
    for (int k = first; k < first + 8; k++) {
        float part = node[k].ball.w < 0.0 ? 0.0 : sent[k].without.a;
        if (part <= 0.0)
            continue;
        chosen = k;
        if (u < part)
            return k;
        u -= part;
    }
    return chosen;
}

float brightness(int first)
{
    float sum = 0.0;
    for (int k = first; first >= 0 && k < first + 8; k++)
        sum += node[k].ball.w < 0.0 ? 0.0 : sent[k].without.a;
    return sum;
}

void put(int i, int k, int tree, float share)
{
    int width = textureSize(place, 0).x, leaf = k + leaf_of[tree];
    ivec2 texel = ivec2(leaf % width, leaf / width);
    vec4 at = texelFetch(place, texel, 0);
    vec3 normal = texelFetch(facing, texel, 0).xyz, to = at.xyz - centre.xyz;
    float far = at.w == 0.0 ? 1.0 : 0.0;
    float size = node[k].area * share / (far > 0.0 ? dot(to, to) : 1.0);
    vec3 start = at.xyz + max(off, centre.w * length(to)) * normal;
    light[i] = Texels(vec4(start, size), vec4(far > 0.0 ? -normal : normal, far),
                      vec4(sent[k].without.rgb, 0.0),
                      vec4(sent[k].with_objects.rgb, float(k)));
}

void main()
{
    int number = int(gl_GlobalInvocationID.x), i = range.x + number, tree = 0;
    if (number >= range.y)
        return;
    if (again) {
        int k = int(light[i].with_objects.w);
        if (light[i].place.w > 0.0)
            light[i].with_objects.rgb = sent[k].with_objects.rgb;
        return;
    }
    float first = brightness(root.x), total = first + brightness(root.y);
    float u = (float(number) + random_at(uint(number), 7u)) / float(range.y) * total;
    light[i] = Texels(vec4(0.0), vec4(0.0, 0.0, 1.0, 0.0), vec4(0.0), vec4(0.0));
    if (total <= 0.0)
        return;
    if (root.x < 0 || (u >= first && root.y >= 0)) {
        tree = 1;
        u -= first;
    }
    int k = choose(root[tree], u);
    while (k >= 0 && node[k].child >= 0.0)
        k = choose(int(node[k].child), u);
    if (k >= 0)
        put(i, k, tree, total / (sent[k].without.a * float(range.y)));
}
