#version 430
// A small picture of what surrounds each place, drawn from trees of points (Ritschel et al. 2009).
// Twins: world/transport/cut.c, world/transport/micro.c. A work group is a place, an invocation one
// pixel of its picture, which goes down to the nodes that may touch it, in the order of the
// library: so there are no lists that could be too short, and a picture is the same each time. What
// is too near to be drawn is met as discs by the pixel's ray, as the paper has it; what points
// cover by less than half shows what they do cover. With SIDE, and PIXELS, its square.
layout(local_size_x = PIXELS) in;
// Directions in the frame of a place, and the part of each pixel within the disc.
layout(std430, binding = 2) readonly buffer Picture { vec4 pixel[]; };
layout(std430, binding = 3) readonly buffer List { uvec4 listed; uint at[]; };  // w: how many
layout(rgba32f, binding = 0) writeonly uniform image2D without;
layout(rgba32f, binding = 1) writeonly uniform image2D with_objects;
uniform samplerBuffer node;       // three texels each, as tree.glsl
uniform samplerBuffer sent;       // two: without objects, with them
uniform sampler2D place, facing;  // of all sites; a place's alpha says what it is
uniform vec2 kind;                // least and most of that
uniform ivec3 root;               // first nodes of scene and objects; -1: there are none
uniform ivec2 first;              // site of the first group
uniform int spacing;              // to the next; 0: sites are listed
uniform vec4 centre;              // the eye that captured the scene; how far off it depth may be wrong
uniform float off;                // where a site of objects begins: off its surface
uniform float whole;              // pixels within the disc

const float PI = 3.14159265358979, NEVER = 1e30;
const float NEARER = 0.8, FULL = 0.5;
const int DEEPEST = 48;  // seven more for each level

struct Light {
    float covers;
    vec3 without, with_objects;
};
struct Disc {
    float order;  // of those that the ray meets, the least
    float distance;
    int node;
};
struct Cell {
    Light near, far;       // of the scene: what is nearest, and all behind it
    Light object;          // of objects: what is nearest
    float depth, far_depth, object_depth, covered;
    Disc close, object_close;
};
struct Site {
    vec3 start, x, y, z;
};

shared vec3 sum[PIXELS];

void add(inout Light to, Light light, float weight)
{
    to.covers += weight * light.covers;
    to.without += weight * light.without;
    to.with_objects += weight * light.with_objects;
}

// Along one side, how much of what lies at `x` belongs to pixel `i`. Twin: square_parts.
float part_along(float x, int i)
{
    float away = x - (float(i) + 0.5);
    if ((i == 0 && away < 0.0) || (i == SIDE - 1 && away > 0.0))
        return 1.0;
    return max(1.0 - abs(away), 0.0);
}

// The nearest disc is taken. Twins: is_low, is_met, disc_of of world/transport/cut.c.
void meet(inout Disc best, int number, vec3 middle, float radius, vec3 normal, Site site, vec3 direction,
          bool fronts)
{
    const float LOW = 0.5, BESIDE = 0.1;
    float height = dot(normal, site.z), tilt = sqrt(max(1.0 - height * height, 0.0));
    float along = dot(normal, direction);
    if (dot(middle, site.z) + radius * tilt < LOW * radius || (fronts && along >= 0.0))
        return;
    float distance = dot(normal, middle) / (along != 0.0 ? along : 1e-30);
    vec3 step = distance * direction - middle;
    float beside = dot(step, step) / (radius * radius);
    float order = distance * (1.0 + BESIDE * beside);
    if (distance > 0.0 && beside <= 1.0 && order < best.order)
        best = Disc(order, distance, number);
}

// What is nearer by a fifth hides the rest. Twin: put_scene.
void put_scene(inout Cell cell, Light light, float depth, float weight)
{
    if (cell.near.covers > 0.0 && depth * NEARER > cell.depth) {
        add(cell.far, light, weight);
        cell.far_depth = max(cell.far_depth, depth);
        return;
    }
    if (cell.near.covers > 0.0 && depth < cell.depth * NEARER) {
        add(cell.far, cell.near, 1.0);
        cell.far_depth = max(cell.far_depth, cell.depth);
        cell.near = Light(0.0, vec3(0.0), vec3(0.0));
    }
    cell.depth = cell.near.covers > 0.0 ? min(cell.depth, depth) : depth;
    add(cell.near, light, weight);
}

// Twin: put_object.
void put_object(inout Cell cell, Light light, float depth, float weight)
{
    cell.covered += weight * light.covers;
    if (cell.object.covers > 0.0 && depth * NEARER > cell.object_depth)
        return;
    if (cell.object.covers > 0.0 && depth < cell.object_depth * NEARER)
        cell.object = Light(0.0, vec3(0.0), vec3(0.0));
    cell.object_depth = cell.object.covers > 0.0 ? min(cell.object_depth, depth) : depth;
    add(cell.object, light, weight);
}

// Twin: cut of world/transport/cut.c. `part` of a pixel is what nodes may be as large as.
void cut(inout Cell cell, Site site, vec3 direction, ivec2 own, int top, float part, bool objects)
{
    const float TOO_WIDE = 2.0, ACROSS = 4.0 / float(PIXELS), HALF = 0.5 * float(SIDE);
    vec2 middle = (vec2(own) + 0.5) / HALF - 1.0;
    int stack[DEEPEST], n = 0;
    stack[n++] = top;
    while (n > 0) {
        int group = stack[--n];
        for (int k = group; k < group + 8; k++) {
            vec4 ball = texelFetch(node, 3 * k);
            vec3 to = ball.xyz - site.start;
            float height = dot(to, site.z);
            if (ball.w < 0.0 || height <= -ball.w)
                continue;
            float square = dot(to, to) + 1e-30, once = inversesqrt(square), depth = square * once;
            float sine = ball.w * once;
            float chord = sine < 1.0 ? sqrt(2.0 - 2.0 * sqrt(1.0 - sine * sine)) : 2.0;
            vec2 uv = vec2(dot(to, site.x), dot(to, site.y)) * once;
            if (any(greaterThan(abs(uv - middle), vec2(chord + 1.0 / HALF))))
                continue;
            vec4 turn = texelFetch(node, 3 * k + 1), more = texelFetch(node, 3 * k + 2);
            float faces = dot(to, turn.xyz), up = height * once;
            if (objects && faces > more.x * depth + more.y)
                continue;
            float size = once * once * max(up, 0.0), wide = (abs(faces) * once + turn.w) * size;
            bool large = PI * sine * sine * min(up + sine, 1.0) > part * ACROSS || sine >= 1.0;
            if (large && more.w >= 0.0) {
                stack[n++] = int(more.w);
            } else if (large && wide > TOO_WIDE * ACROSS) {
                vec3 normal = turn.xyz / max(length(turn.xyz), 1e-30);
                if (objects)
                    meet(cell.object_close, k, to, ball.w, normal, site, direction, true);
                else
                    meet(cell.close, k, to, ball.w, normal, site, direction, false);
            } else if (up > 0.0) {
                vec2 at = (uv + 1.0) * HALF;
                float weight = part_along(at.x, own.x) * part_along(at.y, own.y);
                float covers = (objects ? 0.5 * (wide - faces * once * size) : wide) / ACROSS;
                if (covers <= 0.0 || weight <= 0.0)
                    continue;
                Light light = Light(covers, covers * texelFetch(sent, 2 * k).rgb,
                                    covers * texelFetch(sent, 2 * k + 1).rgb);
                if (objects)
                    put_object(cell, light, depth, weight);
                else
                    put_scene(cell, light, depth, weight);
            }
        }
    }
}

// What a pixel shows of the scene. Twins: from_points, from_ray.
void show_scene(out Light shown, out float depth, out float hides, out float deepest, Cell cell,
                float inside)
{
    float all = cell.near.covers + cell.far.covers, covers = cell.near.covers / inside;
    shown = Light(1.0, vec3(0.0), vec3(0.0));
    depth = deepest = NEVER;
    hides = 1.0;
    if (cell.close.node >= 0 && (cell.near.covers < FULL * inside || cell.close.distance < cell.depth)) {
        shown = Light(1.0, texelFetch(sent, 2 * cell.close.node).rgb,
                      texelFetch(sent, 2 * cell.close.node + 1).rgb);
        depth = deepest = cell.close.distance;
        return;
    }
    if (all <= 0.0)
        return;
    bool full = covers > FULL || cell.far.covers <= 0.0;
    depth = cell.near.covers > 0.0 ? cell.depth : cell.far_depth;
    deepest = full ? depth : cell.far_depth;
    hides = full ? 1.0 : all < FULL * inside ? cell.near.covers / all : covers;
    if (cell.near.covers > 0.0) {
        shown.without += hides / cell.near.covers * cell.near.without;
        shown.with_objects += hides / cell.near.covers * cell.near.with_objects;
    }
    if (!full) {
        shown.without += (1.0 - hides) / cell.far.covers * cell.far.without;
        shown.with_objects += (1.0 - hides) / cell.far.covers * cell.far.with_objects;
    }
}

// Twin: part_of of world/transport/micro.c.
float part_of(Cell cell, float depth, float hides, float deepest, float inside)
{
    const float BEHIND = 1.05;
    float part = min(cell.covered / inside, 1.0);
    if (cell.object_depth > BEHIND * deepest)
        return 0.0;
    return cell.object_depth > BEHIND * depth ? part * (1.0 - hides) : part;
}

// Twin: resolve of world/transport/micro.c.
Light resolve(Cell cell, float inside)
{
    Light shown;
    float depth, hides, deepest;
    show_scene(shown, depth, hides, deepest, cell, inside);
    if (cell.object_close.node >= 0) {
        if (cell.object_close.distance < depth)
            shown.with_objects = texelFetch(sent, 2 * cell.object_close.node + 1).rgb;
    } else if (cell.object.covers > 0.0) {
        float part = part_of(cell, depth, hides, deepest, inside);
        shown.with_objects = mix(shown.with_objects, cell.object.with_objects / cell.object.covers, part);
    }
    return shown;
}

Light look(Site site, int me)
{
    Light none = Light(0.0, vec3(0.0), vec3(0.0));
    Disc nothing = Disc(NEVER, NEVER, -1);
    Cell cell = Cell(none, none, none, 0.0, 0.0, 0.0, 0.0, nothing, nothing);
    vec4 pixel_of = pixel[me];
    ivec2 own = ivec2(me % SIDE, me / SIDE);
    if (pixel_of.w <= 0.0)
        return none;
    float up = sqrt(max(1.0 - dot(pixel_of.xy, pixel_of.xy), 0.0));
    vec3 direction = pixel_of.x * site.x + pixel_of.y * site.y + up * site.z;
    for (int tree = 0; tree < 3; tree++)
        if (root[tree] >= 0)
            cut(cell, site, direction, own, root[tree], tree == 0 ? 4.0 : 0.25, tree > 0);
    return resolve(cell, pixel_of.w);
}

// Over all pixels.
vec3 sum_up(vec3 own, int me)
{
    sum[me] = own;
    barrier();
    for (int n = PIXELS; n > 1; n = (n + 1) / 2) {
        if (me < n / 2)
            sum[me] += sum[me + (n + 1) / 2];
        barrier();
    }
    return sum[0];
}

void main()
{
    ivec2 group = ivec2(gl_WorkGroupID.xy), site_at = first + spacing * group;
    int me = int(gl_LocalInvocationID.x);
    if (spacing == 0) {
        uint number = uint(group.x) + gl_NumWorkGroups.x * uint(group.y);
        if (number >= listed.w)
            return;
        int width = textureSize(place, 0).x;
        site_at = ivec2(int(at[number]) % width, int(at[number]) / width);
    }
    if (any(greaterThanEqual(site_at, textureSize(place, 0))))
        return;
    vec4 where = texelFetch(place, site_at, 0);
    if (where.w < kind.x || where.w > kind.y)
        return;
    Site site;
    site.z = texelFetch(facing, site_at, 0).xyz;
    vec3 any_way = abs(site.z.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    site.x = normalize(cross(any_way, site.z));
    site.y = cross(site.z, site.x);
    site.start = where.xyz + max(off, centre.w * distance(where.xyz, centre.xyz)) * site.z;
    Light shown = look(site, me);
    float share = pixel[me].w / whole;
    vec3 bare = sum_up(share * shown.without, me);
    barrier();
    vec3 full = sum_up(share * shown.with_objects, me);
    if (me == 0) {
        imageStore(without, site_at, vec4(bare, 1.0));
        imageStore(with_objects, site_at, vec4(full, 1.0));
    }
}
