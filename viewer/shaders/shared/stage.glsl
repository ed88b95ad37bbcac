// Rays through the depth of a view. RAYS is defined as one of the four kinds. Twin:
// src/relight/shadow/stage.c.
const int PARALLEL = 0, EYE = 1, CYLINDER = 2, SPHERE = 3;  // enum relume_shadows_rays
const int TILE = 8;                                         // RELUME_SHADOW_TILE
const float STEP = 0.7, START = 1.0, NEAR = 0.25, SAME = 12.0;
const int MOST_STEPS = 65536;
const float BACKGROUND = 1e30;

uniform sampler2D surface;  // how far, how thick; BACKGROUND: nothing there
uniform sampler2D span;     // nearest and farthest of the four pixels around a corner
uniform sampler2D front;    // what is nearest in a tile or beside it
uniform vec4 window;        // scale, shift: pixels of coordinates
uniform float axis, pixel_side, least_side;
uniform vec3 low, high;     // a box around the surface

struct Place {
    vec2 at;
    float far;
};

// Where in the view a position of the picture lies, which may be a reduced one. The shader defines
// it.
vec2 stage_place(vec2 position);

vec3 ray_of(vec2 at)
{
    vec2 a = (at - window.zw) / window.xy;
    if (RAYS == CYLINDER)
        return vec3(sin(a.x), a.y, -cos(a.x));
    if (RAYS == SPHERE)
        return vec3(sin(a.x) * cos(a.y), sin(a.y), -cos(a.x) * cos(a.y));
    return vec3(a, RAYS == EYE ? axis : 0.0);
}

// False outside the picture.
bool place_of(out Place p, vec3 point)
{
    vec2 a = point.xy, size = vec2(textureSize(surface, 0));
    p.far = axis * point.z;
    if (RAYS == EYE)
        a /= p.far;
    if (RAYS >= CYLINDER) {
        float level = length(point.xz);
        p.far = RAYS == CYLINDER ? level : length(point);
        a = vec2(atan(point.x, -point.z),
                 RAYS == CYLINDER ? point.y / level : atan(point.y, level));
    }
    p.at = window.xy * a + window.zw;
    if (RAYS >= CYLINDER && p.at.x >= size.x)
        p.at.x = 0.0;
    return (RAYS == PARALLEL || p.far > 0.0) && all(greaterThanEqual(p.at, vec2(0.0))) &&
           all(lessThan(p.at, size));
}

float side_at(float far)
{
    return RAYS == PARALLEL ? pixel_side : max(pixel_side * far, least_side);
}

float far_of(ivec2 at)
{
    ivec2 size = textureSize(surface, 0);
    if (RAYS >= CYLINDER)
        at.x = (at.x + size.x) % size.x;
    return texelFetch(surface, clamp(at, ivec2(0), size - 1), 0).r;
}

vec2 span_at(vec2 at)
{
    return texelFetch(span, ivec2(at + 0.5), 0).rg;
}

// The plane of four pixels where they are of one surface; elsewhere the nearest of them.
float surface_at(vec2 at)
{
    ivec2 first = ivec2(at + 0.5) - 1;
    vec2 part = at - 0.5 - vec2(first), s = span_at(at), rest = 1.0 - part;
    if (!(s.y - s.x < SAME * side_at(s.x)))
        return far_of(first + ivec2(greaterThan(part, vec2(0.5))));
    vec4 z = vec4(far_of(first), far_of(first + ivec2(1, 0)), far_of(first + ivec2(0, 1)),
                  far_of(first + 1));
    vec4 w = vec4(rest.x * rest.y, part.x * rest.y, rest.x * part.y, part.x * part.y);
    return RAYS == PARALLEL ? dot(w, z) : 1.0 / dot(w, 1.0 / z);
}

bool stage_point(out vec3 point, vec2 at)
{
    float far = surface_at(at);
    vec3 ray = ray_of(at);
    point = RAYS == PARALLEL ? vec3(ray.xy, -far) : far * ray;
    return far < 0.5 * BACKGROUND;
}

float leaves_box(vec3 p, vec3 d)
{
    float end = BACKGROUND;
    for (int i = 0; i < 3; i++)
        if (d[i] != 0.0)
            end = min(end, ((d[i] > 0.0 ? high[i] : low[i]) - p[i]) / d[i]);
    return end;
}

bool is_free(Place p, float side)
{
    return p.far + float(TILE) * side < texelFetch(front, ivec2(p.at) / TILE, 0).r;
}

// Whether light from direction `d` (of the view), and so far away, reaches a point of the surface.
bool stage_reaches(vec3 point, vec3 d, float distance)
{
    float end = min(leaves_box(point, d), distance);
    Place p, last;
    if (!place_of(p, point))
        return true;
    float side = side_at(p.far), t = START * side;
    bool was_behind = false;
    last = p;
    for (int i = 0; i < MOST_STEPS && t < end; i++) {
        if (!place_of(p, point + t * d))
            return true;
        side = side_at(p.far);
        if (!was_behind && is_free(p, side)) {
            t += float(TILE - 1) * side;
            continue;
        }
        vec2 s = span_at(p.at);
        bool behind = p.far - s.x > NEAR * side;
        if (behind || was_behind) {
            float now = surface_at(p.at);
            behind = behind && p.far - now > NEAR * side;
            if (behind != was_behind && abs(now - surface_at(last.at)) < SAME * side)
                return false;
            if (behind && p.far - now < texelFetch(surface, ivec2(p.at), 0).g)
                return false;
        }
        last = p;
        was_behind = behind;
        t += STEP * side;
    }
    return true;
}

// The same of a quarter of a pixel.
bool quarter_reached(ivec2 at, int quarter, vec3 d, float distance)
{
    vec3 point;
    vec2 middle = vec2((quarter & 1) != 0 ? 0.75 : 0.25, (quarter & 2) != 0 ? 0.75 : 0.25);
    return !stage_point(point, stage_place(vec2(at) + middle)) || stage_reaches(point, d, distance);
}

int quarters_reached(ivec2 at, vec3 d, float distance)
{
    int arrives = 0;
    for (int i = 0; i < 4; i++)
        if (quarter_reached(at, i, d, distance))
            arrives++;
    return arrives;
}
