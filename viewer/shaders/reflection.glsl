// Edited reflections: the rotation of a reflected direction at a point. Twins:
// src/world/reflect/rotation.c, src/world/reflect/turn.c.
uniform samplerBuffer edit;  // of each set of constraints two texels, then what they point to:
                             // centre, radius; border, strokes' points (-1: everywhere; from -2
                             // down: along field 0 and on), first, members; of a constraint its
                             // place and field (-1: straight), original, edited
uniform int edit_sets;
uniform float edit_least;
uniform samplerBuffer along;  // distances along the surface: of each field, of each vertex
uniform int along_vertices;   // how many; 0: there are no fields
uniform float along_edge;     // mean length

const float NEVER = 1e14;  // distances from here on are infinite

ivec3 corner;        // of the triangle that the place lies on; set where there are fields
vec3 corner_weight;

// Turns that are smaller than this part of the first singular value are rounding.
const float OPEN = 1e-5;

vec3 some_across(vec3 v)
{
    return normalize(cross(v, abs(v.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
}

mat3 rotation_least(vec3 from, vec3 to)
{
    vec3 c = cross(from, to);
    float cosine = dot(from, to);
    if (cosine > -1.0 + 1e-6)
        return mat3(cosine, c.z, -c.y, -c.z, cosine, c.x, c.y, -c.x, cosine) +
               outerProduct(c, c) / (1.0 + cosine);
    vec3 axis = some_across(from);
    return 2.0 * outerProduct(axis, axis) - mat3(1.0);
}

void annihilate(inout mat3 a, inout mat3 v, int p, int q)
{
    if (a[p][q] == 0.0)
        return;
    float tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    float t = (tau < 0.0 ? -1.0 : 1.0) / (abs(tau) + sqrt(1.0 + tau * tau));
    float c = inversesqrt(1.0 + t * t);
    float s = t * c;
    mat3 turn = mat3(1.0);
    turn[p][p] = c;
    turn[q][q] = c;
    turn[p][q] = -s;
    turn[q][p] = s;
    a = transpose(turn) * a * turn;
    v = v * turn;
}

vec3 first_axis(mat3 m)
{
    mat3 a = transpose(m) * m;
    mat3 v = mat3(1.0);
    for (int i = 0; i < 4; i++) {
        annihilate(a, v, 0, 1);
        annihilate(a, v, 0, 2);
        annihilate(a, v, 1, 2);
    }
    vec3 first = a[1][1] > a[0][0] ? v[1] : v[0];
    return normalize(a[2][2] > max(a[0][0], a[1][1]) ? v[2] : first);
}

mat3 rotation_nearest(mat3 m)
{
    vec3 v = first_axis(m);
    vec3 image = m * v;
    float largest = length(image);
    if (!(largest > 0.0))
        return mat3(1.0);
    mat3 least = rotation_least(v, image / largest);
    vec3 x = some_across(v);
    vec3 y = cross(v, x);
    float across = dot(least * x, m * x) + dot(least * y, m * y) + OPEN * largest;
    float along = dot(least * y, m * x) - dot(least * x, m * y);
    float size = length(vec2(across, along));
    float c = size > 0.0 ? across / size : 1.0;
    float s = size > 0.0 ? along / size : 0.0;
    return least * (outerProduct(v, v) + outerProduct(c * x + s * y, x) +
                    outerProduct(c * y - s * x, y));
}

float to_stroke(int first, int points, vec3 place)
{
    vec3 a = texelFetch(edit, first).xyz;
    float least = distance(a, place);
    for (int i = 1; i < points; i++) {
        vec3 ab = texelFetch(edit, first + i).xyz - a;
        float t = dot(ab, ab) > 0.0 ? dot(place - a, ab) / dot(ab, ab) : 0.0;
        least = min(least, distance(a + clamp(t, 0.0, 1.0) * ab, place));
        a += ab;
    }
    return least;
}

float falling(float d, float radius, float border)
{
    float t = border > 0.0 ? clamp((radius + border - d) / border, 0.0, 1.0)
                           : (d <= radius ? 1.0 : 0.0);
    return t * t * (3.0 - 2.0 * t);
}

float along_surface(int field, vec3 from, vec3 place)
{
    float sum = 0.0;
    for (int k = 0; k < 3; k++)
        if (corner_weight[k] > 0.0)
            sum += corner_weight[k] * texelFetch(along, field * along_vertices + corner[k]).x;
    return mix(sum, distance(from, place), falling(sum, 2.0 * along_edge, 2.0 * along_edge));
}

float edit_weight(vec4 region, vec4 set, vec3 place)
{
    int points = int(set.y);
    if (points == -1)
        return 1.0;
    float d = points > 0   ? to_stroke(int(set.z) + 3 * int(set.w), points, place)
              : points < 0 ? along_surface(-2 - points, region.xyz, place)
                           : distance(region.xyz, place);
    return falling(d, region.w, set.x);
}

mat3 edit_rotation(int first, int members, vec3 place)
{
    if (members == 1)
        return rotation_least(texelFetch(edit, first + 1).xyz, texelFetch(edit, first + 2).xyz);
    mat3 sum = mat3(0.0);
    float total = 0.0;
    for (int i = 0; i < members; i++) {
        vec4 from = texelFetch(edit, first + 3 * i);
        float far = from.w < 0.0 ? distance(from.xyz, place)
                                 : along_surface(int(from.w), from.xyz, place);
        float d = max(far, edit_least) / edit_least;
        float weight = far < NEVER ? 1.0 / (d * d) : 0.0;
        sum += weight * outerProduct(texelFetch(edit, first + 3 * i + 2).xyz,
                                     texelFetch(edit, first + 3 * i + 1).xyz);
        total += weight;
    }
    return total > 0.0 ? rotation_nearest(sum / total) : mat3(1.0);
}

vec3 edited(vec3 place, vec3 r)
{
    mat3 sum = mat3(0.0);
    mat3 last = mat3(1.0);
    float total = 0.0;
    int counted = 0;
    for (int i = 0; i < edit_sets; i++) {
        vec4 region = texelFetch(edit, 2 * i);
        vec4 set = texelFetch(edit, 2 * i + 1);
        float a = set.w > 0.0 ? edit_weight(region, set, place) : 0.0;
        if (a <= 0.0)
            continue;
        last = edit_rotation(int(set.z), int(set.w), place);
        sum += a * last;
        total += a;
        counted++;
    }
    if (counted > 1 || (counted == 1 && total < 1.0))
        last = rotation_nearest(sum + max(1.0 - total, 0.0) * outerProduct(r, r));
    return last * r;
}
