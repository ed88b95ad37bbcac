// Turned by the shortest way that brings `n` to +z. Twin: vec3_upright.
vec3 upright(vec3 a, vec3 n)
{
    vec3 middle = vec3(n.xy, n.z + 1.0);
    vec3 b = a - middle * (dot(a, middle) / (1.0 + n.z));
    return vec3(b.xy, b.z + 2.0 * dot(n, a));
}
