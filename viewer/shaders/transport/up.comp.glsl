#version 430
// Nodes send the mean of what their children do, by area. Twin: hierarchy_light.
layout(local_size_x = 64) in;
#include "transport/tree.glsl"
layout(std430, binding = 1) buffer Sents { Sent sent[]; };
uniform ivec2 range;  // first node, and behind the last

void main()
{
    int i = range.x + int(gl_GlobalInvocationID.x);
    if (i >= range.y || node[i].child < 0.0 || node[i].area <= 0.0)
        return;
    Sent sum = Sent(vec4(0.0), vec4(0.0));
    int below = int(node[i].child);
    for (int k = below; k < below + 8; k++) {
        float weight = node[k].area / node[i].area;
        if (node[k].ball.w < 0.0)
            continue;
        sum.without += vec4(vec3(weight), 1.0) * sent[k].without;
        sum.with_objects += weight * sent[k].with_objects;
    }
    sent[i] = sum;
}
