#version 430
// Light gathered from virtual lights with imperfect shadow maps: a pixel from some of them, its neighbours
// from the others; leaves of objects from every so many. Twin: instant.c. With SIZE, texels of a map.
layout(local_size_x = 8, local_size_y = 8) in;
#include "transport/virtual.glsl"
#include "transport/virtual_fetch.glsl"
layout(rgba32f, binding = 0) writeonly uniform image2D without;
layout(rgba32f, binding = 1) writeonly uniform image2D with_objects;
uniform sampler2D place, facing;           // of all sites; a place's alpha says what it is
uniform sampler2D of_scene, of_objects;    // maps
uniform vec2 kind, square;                 // of sites: least and most alpha; what points of maps stand for
uniform ivec2 first;                       // site of the first invocation
uniform ivec2 lights;                      // on the scene, and in all
uniform int pattern;                       // 0: sites are leaves
uniform vec4 centre;
uniform float off;

const float NEVER = 1e30;

struct Site {
    vec3 position, normal, start;
};

// Twins: maps_open, bias.
bool open(sampler2D maps, int number, Look l, float square, Site site)
{
    const float STEEPEST = 0.05;
    vec4 at;
    if (!find(at, l, site.position))
        return true;
    int across = textureSize(maps, 0).x / SIZE;
    ivec2 inside = clamp(ivec2(0.5 * float(SIZE) * (at.xy + 1.0)), ivec2(0), ivec2(SIZE - 1));
    float depth = texelFetch(maps, SIZE * ivec2(number % across, number / across) + inside, 0).r;
    float cosine = max(abs(dot(site.normal, way_to(l, site.position))), STEEPEST);
    return depth >= NEVER || at.z <= depth + max(2.0 / (float(SIZE) * at.w), square) / cosine;
}

// Twin: virtual_sight.
float share_of(Virtual v, Site site)
{
    if (v.far)
        return max(dot(v.normal, site.normal), 0.0) * v.size / PI;
    vec3 to = v.place - site.start;
    float apart = dot(to, to), here = dot(to, site.normal), there = -dot(to, v.normal);
    if (here <= 0.0 || there <= 0.0 || apart <= 0.0)
        return 0.0;
    return v.size * (here * there / apart) / max(PI * apart, v.size);
}

void gather_one(inout vec3 bare, inout vec3 full, Site site, int i, float times)
{
    Virtual v = virtual_at(i);
    float share = v.size > 0.0 ? times * share_of(v, site) : 0.0;
    if (share <= 0.0 || !open(of_scene, i, look_of(v, false), square.x, site))
        return;
    bare += share * v.without;
    if (open(of_objects, i, look_of(v, true), square.y, site))
        full += share * v.with_objects;
}

void gather_some(inout vec3 bare, inout vec3 full, Site site, uint key, int begin, int end)
{
    const int MOST = 128;
    int step = (end - begin + MOST - 1) / MOST;
    for (int i = begin + int(key % uint(max(step, 1))); i < end; i += step)
        gather_one(bare, full, site, i, float(step));
}

void main()
{
    ivec2 at = first + ivec2(gl_GlobalInvocationID.xy), size = textureSize(place, 0);
    if (any(greaterThanEqual(at, size)))
        return;
    vec4 where = texelFetch(place, at, 0);
    if (where.w < kind.x || where.w > kind.y)
        return;
    vec3 normal = texelFetch(facing, at, 0).xyz, bare = vec3(0.0), full = vec3(0.0);
    float away = max(off, centre.w * distance(where.xyz, centre.xyz));
    Site site = Site(where.xyz, normal, where.xyz + away * normal);
    if (pattern == 0) {
        uint key = mixed(uint(at.x + size.x * at.y));
        gather_some(bare, full, site, key, 0, lights.x);
        gather_some(bare, full, site, key, lights.x, lights.y);
    } else {
        int step = pattern * pattern, own = at.x % pattern + pattern * (at.y % pattern);
        for (int i = 0; i < lights.y; i++) {
            vec4 v = texelFetch(light, 4 * i);  // what is far away stands farther off than that
            vec3 to = v.xyz - site.start;
            if (float(step) * v.w > PI * dot(to, to))
                gather_one(bare, full, site, i, 1.0);
            else if (i % step == own)
                gather_one(bare, full, site, i, float(step));
        }
    }
    imageStore(without, at, vec4(bare, 1.0));
    imageStore(with_objects, at, vec4(full, 1.0));
}
