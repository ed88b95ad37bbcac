// Where a ray that starts at a place ends in a panorama with depth. Twin: mirror.c.
uniform sampler2D places;  // that the panorama shows
uniform vec3 centre;       // its eye

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
