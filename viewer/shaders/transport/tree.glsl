// Trees of points, and what they send. Twin: world/transport/hierarchy.h.
struct Node {
    vec4 ball;    // middle, radius; below 0: there is none
    vec4 facing;  // sum of areas times normals; half of what cancels in it
    float cone, edge, area;
    float child;  // node of the first of eight children; -1: it is a leaf
};
struct Sent {
    vec4 without, with_objects;  // alpha of the first: how bright it is, of nodes the sum
};
layout(std430, binding = 0) readonly buffer Nodes { Node node[]; };
