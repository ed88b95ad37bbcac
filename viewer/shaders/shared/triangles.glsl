// Nodes of a triangle of lights and their shares, from barycentric numbers; a corner of -1 is no
// light. Twin: src/relight/light/triangles.c.
void triangle_shares(out ivec3 node, inout vec3 share, vec3 corner)
{
    vec3 says = vec3(greaterThanEqual(corner, vec3(0.0)));
    share = max(share, 0.0) * says;
    float sum = share.x + share.y + share.z;
    share = sum > 0.0 ? share / sum : says / max(says.x + says.y + says.z, 1.0);
    node = ivec3(max(corner, 0.0));
}
