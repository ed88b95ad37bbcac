// What arrives at each pixel from all directions: as the frame shows it near by, else as the
// captured panorama sends it. Twin: world/transport/screen.c. Here all directions are spread as the
// cosine. With MEAN: the mean of the panorama over all directions.
#include "follow.glsl"

#ifdef MEAN
out vec4 color;

// Twin: scenery_mean.
void main()
{
    const int DIRECTIONS = 1024;
    float golden = PI * (3.0 - sqrt(5.0));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < DIRECTIONS; i++) {
        float z = 1.0 - (2.0 * float(i) + 1.0) / float(DIRECTIONS), r = sqrt(1.0 - z * z);
        float turn = golden * float(i);
        sum += panorama_sample(vec3(r * cos(turn), z, r * sin(turn))).rgb;
    }
    color = vec4(sum / float(DIRECTIONS), 1.0);
}
#else
uniform sampler2D scene, scene_facing;      // the scene: places, normals
uniform sampler2D front, facing, shown;     // what is nearest; its normals, with the depth of its back
uniform sampler2D lone;                     // what the scene alone shows
uniform sampler2D mean;                     // one texel
uniform sampler2D all_without, all_with;    // lamps.frag
uniform vec3 middle;                        // of the ball about the objects
uniform bool at_objects;                    // else at the scene
uniform bool directional, bounces;
uniform int samples, pattern;
uniform float radius;
uniform mat4 clip;
uniform vec4 eye;
layout(location = 0) out vec4 without;
layout(location = 1) out vec4 with_objects;

uint mixed(uint x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

float random_at(uint key, uint number)
{
    return float(mixed(mixed(key) + number) >> 8) / 16777216.0;
}

// Twin: mirrored of world/transport/transport.c.
float mirrored(uint i)
{
    i = (i << 16) | (i >> 16);
    i = ((i & 0x00ff00ffu) << 8) | ((i & 0xff00ff00u) >> 8);
    i = ((i & 0x0f0f0f0fu) << 4) | ((i & 0xf0f0f0f0u) >> 4);
    i = ((i & 0x33333333u) << 2) | ((i & 0xccccccccu) >> 2);
    i = ((i & 0x55555555u) << 1) | ((i & 0xaaaaaaaau) >> 1);
    return float(i) / 4294967296.0;
}

// Twin: spread of world/transport/transport.c.
vec3 spread(vec3 normal, float u, float v)
{
    float r = sqrt(u), up = sqrt(max(1.0 - u, 1e-6)), around = 2.0 * PI * v;
    vec3 any = abs(normal.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 x = normalize(cross(any, normal)), y = cross(normal, x);
    return normalize(r * cos(around) * x + r * sin(around) * y + up * normal);
}

float depth_of(vec3 point)
{
    return eye.w > 0.0 ? distance(point, eye.xyz) : -dot(point, eye.xyz);
}

// Twin: block of world/transport/screen.c.
float part_blocked(vec4 seen, float back, vec3 site, vec3 tried)
{
    const float BEGIN = 0.7;
    float depth = depth_of(tried);
    if (seen.w == 0.0 || depth <= depth_of(seen.xyz) || depth > back)
        return 0.0;
    return 1.0 - smoothstep(BEGIN, 1.0, distance(seen.xyz, site) / radius);
}

// Twin: arrive_from of world/transport/screen.c.
vec3 sent_by(vec3 colour, vec3 seen, vec3 normal, vec3 site)
{
    return dot(site - seen, normal) > 0.0 ? max(colour, 0.0) : vec3(0.0);
}

// Objects block and send light within the radius, and throw shadows; all else is as without them.
bool is_changed(ivec2 pixel, vec3 place)
{
    return distance(place, middle) < 2.0 * radius ||
           texelFetch(all_without, pixel, 0) != texelFetch(all_with, pixel, 0);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), size = textureSize(front, 0);
    vec4 site = at_objects ? texelFetch(front, pixel, 0) : texelFetch(scene, pixel, 0);
    site.w = !at_objects && site.w > 0.0 ? 1.0 : site.w;
    if (site.w != (at_objects ? 2.0 : 1.0))
        discard;
    if (!at_objects && !is_changed(pixel, site.xyz))
        discard;
    vec3 normal = at_objects ? texelFetch(facing, pixel, 0).xyz : texelFetch(scene_facing, pixel, 0).xyz;
    float off = at_objects ? 1e-3 * radius : 0.005 * distance(site.xyz, centre);
    vec3 start = site.xyz + off * normal;
    uint key = uint(pixel.x % pattern + pattern * (pixel.y % pattern));
    float a = random_at(key, 0u), b = random_at(key, 1u);
    vec3 even = texelFetch(mean, ivec2(0), 0).rgb, bare_sum = vec3(0.0), full_sum = vec3(0.0);
    for (int i = 0; i < samples; i++) {
        vec3 towards = spread(normal, fract((float(i) + 0.5) / float(samples) + a),
                              fract(mirrored(uint(i)) + b));
        vec3 tried = start + radius * (1.0 - random_at(key, uint(i) + 2u)) * towards;
        vec3 open = directional ? max(panorama_sample(seen_along(start, towards)).rgb, 0.0) : even;
        vec4 at = clip * vec4(tried, 1.0);
        vec2 xy = (0.5 * at.xy / at.w + 0.5) * vec2(size);
        vec3 bare = open, full = open;
        if (at.w > 0.0 && all(greaterThanEqual(xy, vec2(0.0))) && all(lessThan(xy, vec2(size)))) {
            ivec2 beside = ivec2(xy);
            vec4 behind = texelFetch(scene, beside, 0), seen = texelFetch(front, beside, 0);
            vec4 turned = texelFetch(facing, beside, 0);
            float part = part_blocked(behind, 1e30, site.xyz, tried);
            vec3 sent = directional ? sent_by(texelFetch(lone, beside, 0).rgb, behind.xyz,
                                              texelFetch(scene_facing, beside, 0).xyz, site.xyz)
                                    : vec3(0.0);
            bare = mix(open, sent, part);
            part = part_blocked(seen, turned.w, site.xyz, tried);
            sent = directional && bounces ? sent_by(texelFetch(shown, beside, 0).rgb, seen.xyz, turned.xyz,
                                                     site.xyz)
                                          : vec3(0.0);
            full = mix(open, sent, part);
        }
        bare_sum += bare;
        full_sum += full;
    }
    without = vec4(bare_sum / float(samples), 1.0);
    with_objects = vec4(full_sum / float(samples), 1.0);
}
#endif
