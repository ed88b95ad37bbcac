// What mirrors show of a panorama, or of an environment map laid out as one. Twin: mirror.c.
#include "reflection.glsl"
uniform sampler2D place, normal_s;  // of the surface
uniform sampler2D triangle;         // x: its number
uniform samplerBuffer vertices;     // three texels each; their places come first
uniform usamplerBuffer triangles;   // three numbers each
uniform sampler2D places;           // that the panorama shows
uniform bool has_places;
uniform vec3 centre;                // the panorama's eye
uniform int part;
uniform vec4 eye, frozen;           // its place, 1; or the direction towards it, 0; frozen: 0, none
uniform vec3 reflectance;
uniform float turn;                 // of an environment, radians
uniform vec3 tint;

#ifdef PANORAMA_LAYOUT
const float FAR = 1e30;

// How far the panorama's eye sees in a direction.
float depth_at(vec3 direction)
{
    vec2 xy;
    int face;
    if (!panorama_pixel(xy, face, direction))
        return FAR;
    ivec2 size = textureSize(places, 0);
    ivec2 at = clamp(ivec2(floor(xy)) + ivec2(face * size.y, 0), ivec2(0), size - 1);
    float depth = distance(texelFetch(places, at, 0).xyz, centre);
    return depth < FAR ? depth : FAR;
}

// x: the part of its way; y: how much farther off it is than what is seen there; z: its depth
vec3 follow(out vec3 direction, vec3 from, vec3 along, float part_of)
{
    vec3 at = from * (1.0 - part_of) + along * (part_of * length(from));
    float size = length(at);
    direction = size > 0.0 && part_of < 1.0 ? at / size : along;
    float depth = depth_at(direction);
    float away = part_of < 1.0 ? size / (1.0 - part_of) : FAR;
    return vec3(part_of, depth < FAR ? away - depth : -FAR, depth);
}

bool close_in(out vec3 hit, vec3 from, vec3 along, vec3 before, vec3 behind)
{
    vec3 direction;
    hit = along;
    for (int i = 0; i < 12; i++) {
        vec3 middle = follow(direction, from, along, 0.5 * (before.x + behind.x));
        if (middle.y > 0.0) {
            behind = middle;
            hit = direction;
        } else {
            before = middle;
        }
    }
    return behind.y <= 0.1 * behind.z;
}

vec3 seen_along(vec3 at, vec3 along)
{
    vec3 from = at - centre;
    vec3 hit;
    vec3 before = follow(hit, from, along, 0.0);
    for (int i = 1; i <= 32; i++) {
        vec3 now = follow(hit, from, along, float(i) / 32.0);
        if (now.y > 0.0 && before.y <= 0.0 && close_in(hit, from, along, before, now))
            return hit;
        before = now;
    }
    return along;
}
#else
vec3 seen_along(vec3 at, vec3 along)
{
    return along;
}
#endif

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
    color = vec4(tint * (reflectance + (1.0 - reflectance) * rest) * panorama_sample(e), 1.0);
}
