// What mirrors show of a panorama, or of an environment map laid out as one. Twin: mirror.c.
#include "reflection.glsl"
#include "follow.glsl"
uniform sampler2D place, normal_s;  // of the surface
uniform sampler2D triangle;         // x: its number
uniform samplerBuffer vertices;     // three texels each; their places come first
uniform usamplerBuffer triangles;   // three numbers each
uniform bool has_places;
uniform int part;
uniform vec4 eye, frozen;           // its place, 1; or the direction towards it, 0; frozen: 0, none
uniform vec3 reflectance;
uniform float turn;                 // of an environment, radians
uniform vec3 tint;

// The weights are areas of the triangle's parts.
void find_corners(ivec2 pixel, vec3 at)
{
    int first = 3 * int(texelFetch(triangle, pixel, 0).x);
    vec3 p[3];
    for (int k = 0; k < 3; k++) {
        corner[k] = int(texelFetch(triangles, first + k).x);
        p[k] = texelFetch(vertices, 3 * corner[k]).xyz;
    }
    vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
    for (int k = 0; k < 3; k++) {
        vec3 a = p[(k + 1) % 3];
        corner_weight[k] = max(dot(cross(p[(k + 2) % 3] - a, at - a), normal), 0.0);
    }
    float sum = corner_weight.x + corner_weight.y + corner_weight.z;
    corner_weight = sum > 0.0 ? corner_weight / sum : vec3(1.0, 0.0, 0.0);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 at = texelFetch(place, pixel, 0);
    if (int(abs(at.w)) != part + 1)
        discard;
    vec3 normal = texelFetch(normal_s, pixel, 0).xyz;
    vec3 view_ray = normalize(eye.w * at.xyz - eye.xyz);
    vec3 i = frozen.w > 0.0 ? normalize(at.xyz - frozen.xyz) : view_ray;
    if (along_vertices > 0)
        find_corners(pixel, at.xyz);
    vec3 e = edited(at.xyz, reflect(i, normal));
    if (has_places)
        e = seen_along(at.xyz, e);
    e = vec3(cos(turn) * e.x - sin(turn) * e.z, e.y, sin(turn) * e.x + cos(turn) * e.z);
    float rest = pow(1.0 - clamp(-dot(normal, view_ray), 0.0, 1.0), 5.0);
    color = vec4(tint * (reflectance + (1.0 - reflectance) * rest) * panorama_sample(e).rgb, 1.0);
}
