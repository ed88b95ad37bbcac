// The triangle of lights around a direction. A page looks through all triangles of its few lights:
// it has them from its core without neighbours. Twin: src/relight/light/triangles.c.
#include "shared/triangles.glsl"
uniform sampler2D triangles;  // rows of nodes, then inverse and neighbour of each corner; then
                              // starts, 16 a row
uniform int triangle_count;   // 0: none

int start_cell(vec3 d)
{
    vec2 at = d.xy / (abs(d.x) + abs(d.y) + abs(d.z));
    vec2 folded = (1.0 - abs(at.yx)) * vec2(at.x < 0.0 ? -1.0 : 1.0, at.y < 0.0 ? -1.0 : 1.0);
    ivec2 cell = clamp(ivec2((0.5 * (d.z >= 0.0 ? at : folded) + 0.5) * 32.0), 0, 31);
    return cell.y * 32 + cell.x;
}

// Nodes and their shares.
void triangles_find(out ivec3 node, out vec3 share, vec3 d)
{
    int start = start_cell(d);
    ivec2 at = ivec2(start >> 2 & 3, triangle_count + (start >> 4));
    int t = int(texelFetch(triangles, at, 0)[start & 3]);
    vec4 inverse[3];
    for (int i = 0; i <= 64; i++) {
        for (int c = 0; c < 3; c++)
            inverse[c] = texelFetch(triangles, ivec2(c + 1, t), 0);
        share = vec3(dot(inverse[0].xyz, d), dot(inverse[1].xyz, d), dot(inverse[2].xyz, d));
        float least = min(share.x, min(share.y, share.z));
        if (least >= -1e-6)
            break;
        t = int(share.x == least ? inverse[0].w : share.y == least ? inverse[1].w : inverse[2].w);
    }
    triangle_shares(node, share, texelFetch(triangles, ivec2(0, t), 0).xyz);
}
