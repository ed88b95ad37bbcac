// Virtual lights and how their shadow maps look at the world. Twins: world/transport/virtual.h,
// world/transport/maps.c, world/transport/instant.c.
struct Virtual {
    vec3 place;   // just off its surface; of one that is far away nothing
    float size;   // an area, or a solid angle; 0: it is dark
    vec3 normal;  // of one that is far away the direction to it
    bool far;
    vec3 without, with_objects;
    int node;
};
uniform vec4 objects;  // the ball about them

struct Look {
    int kind;
    vec3 place, x, y, z;
    float width;
};
const int HEMISPHERE = 1, CONE = 2, FAR = 3;
const float PI = 3.14159265358979;

Look look_along(int kind, vec3 place, vec3 z, float width)
{
    vec3 any_way = abs(z.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 x = normalize(cross(any_way, z));
    return Look(kind, place, x, cross(z, x), z, width);
}

// Of the map of the scene, or of the objects.
Look look_of(Virtual v, bool at_objects)
{
    const float NEAR = 1.25, WIDER = 1.02, SCENE = 4.0;
    if (v.far)
        return look_along(FAR, objects.xyz, -v.normal, at_objects ? objects.w : SCENE * objects.w);
    vec3 to = objects.xyz - v.place;
    float away = length(to), radius = WIDER * objects.w;
    if (!at_objects || away <= NEAR * radius)
        return look_along(HEMISPHERE, v.place, v.normal, 1.0);
    return look_along(CONE, v.place, to / away, radius / sqrt(away * away - radius * radius));
}

// Where a place lies in a map: -1 to 1 along both sides; its depth, and how much of a side one unit
// of length takes up there. Twin: find of world/transport/maps.c.
bool find(out vec4 at, Look l, vec3 place)
{
    const float LOWEST = 0.02;
    vec3 to = place - l.place, q = vec3(dot(to, l.x), dot(to, l.y), dot(to, l.z));
    if (l.kind == FAR) {
        float s = 1.0 / (length(q.xy) + l.width);
        at = vec4(s * q.xy, q.z, s * sqrt(s * l.width));
        return true;
    }
    float away = length(to), s = l.kind == CONE ? 1.0 / (q.z * l.width) : 1.0 / (away + q.z);
    at = vec4(s * q.xy, away, s);
    return q.z > LOWEST * away && all(lessThan(abs(at.xy), vec2(1.0)));
}

vec3 way_to(Look l, vec3 place)
{
    return l.kind == FAR ? l.z : normalize(place - l.place);
}

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
