// movingshaders.js - shadows and highlights that move, on the graphics card; twins of
// viewer/shaders/moving and of src/relight/shadow
import { ARRIVING, TRIANGLES } from './near.js';
import { DECODE, HEAD } from './shaders.js';

// A pixel of a reduced picture is so many of the view's wide.
const GRAIN = 'uniform float grain;\n';

// Rays through the depth of a view; after viewer/shaders/moving/stage.glsl.
const stageShader = (rays) => `${GRAIN}const int RAYS = ${rays}, PARALLEL = 0, EYE = 1, CYLINDER = 2;
const int TILE = 8, MOST_STEPS = 65536;
const float STEP = 0.7, START = 1.0, NEAR = 0.25, SAME = 12.0, BACKGROUND = 1e30;
uniform sampler2D surface;  // how far, how thick
uniform sampler2D span;     // nearest and farthest of the four pixels around a corner
uniform sampler2D front;    // what is nearest in a tile or beside it
uniform vec4 window;        // scale, shift: pixels of coordinates
uniform vec3 sides;         // axis, side of a pixel, least side
uniform vec3 low, high;     // a box around the surface
struct Place { vec2 at; float far; };
vec3 ray_of(vec2 at)
{
    vec2 a = (at - window.zw) / window.xy;
    if (RAYS == CYLINDER)
        return vec3(sin(a.x), a.y, -cos(a.x));
    if (RAYS > CYLINDER)
        return vec3(sin(a.x) * cos(a.y), sin(a.y), -cos(a.x) * cos(a.y));
    return vec3(a, RAYS == EYE ? sides.x : 0.0);
}
bool place_of(out Place p, vec3 point)
{
    vec2 a = point.xy, size = vec2(textureSize(surface, 0));
    p.far = sides.x * point.z;
    if (RAYS == EYE)
        a /= p.far;
    if (RAYS >= CYLINDER) {
        float level = length(point.xz);
        p.far = RAYS == CYLINDER ? level : length(point);
        a = vec2(atan(point.x, -point.z), RAYS == CYLINDER ? point.y / level : atan(point.y, level));
    }
    p.at = window.xy * a + window.zw;
    if (RAYS >= CYLINDER && p.at.x >= size.x)
        p.at.x = 0.0;
    return (RAYS == PARALLEL || p.far > 0.0) && all(greaterThanEqual(p.at, vec2(0.0))) && all(lessThan(p.at, size));
}
float side_at(float far) { return RAYS == PARALLEL ? sides.y : max(sides.y * far, sides.z); }
float far_of(ivec2 at)
{
    ivec2 size = textureSize(surface, 0);
    if (RAYS >= CYLINDER)
        at.x = (at.x + size.x) % size.x;
    return texelFetch(surface, clamp(at, ivec2(0), size - 1), 0).r;
}
vec2 span_at(vec2 at) { return texelFetch(span, ivec2(at + 0.5), 0).rg; }
float surface_at(vec2 at)
{
    ivec2 first = ivec2(at + 0.5) - 1;
    vec2 part = at - 0.5 - vec2(first), s = span_at(at), rest = 1.0 - part;
    if (!(s.y - s.x < SAME * side_at(s.x)))
        return far_of(first + ivec2(greaterThan(part, vec2(0.5))));
    vec4 z = vec4(far_of(first), far_of(first + ivec2(1, 0)), far_of(first + ivec2(0, 1)), far_of(first + 1));
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
bool quarter_reached(ivec2 at, int quarter, vec3 d, float distance)
{
    vec3 point;
    vec2 place = grain * (vec2(at) + vec2((quarter & 1) != 0 ? 0.75 : 0.25, (quarter & 2) != 0 ? 0.75 : 0.25));
    return !stage_point(point, min(place, vec2(textureSize(surface, 0)) - 0.01)) || stage_reaches(point, d, distance);
}
float quarters_reached(ivec2 at, vec3 d, float distance)
{
    float arrives = 0.0;
    for (int i = 0; i < 4; i++)
        arrives += quarter_reached(at, i, d, distance) ? 0.25 : 0.0;
    return arrives;
}
`;

// What share of a pixel a distant light reaches, of a tile and a border of one pixel around it.
export const traceShader = (rays) => `${HEAD}${stageShader(rays)}
uniform vec3 direction;
uniform vec2 origin, most;  // of the tile in its level; the size of that
out vec4 share;
void main()
{
    ivec2 size = ivec2(most), at = ivec2(gl_FragCoord.xy) + ivec2(origin) - 1;
    at.x = RAYS >= CYLINDER ? (at.x + size.x) % size.x : clamp(at.x, 0, size.x - 1);
    at.y = clamp(at.y, 0, size.y - 1);
    share = vec4(quarters_reached(at, direction, BACKGROUND));
}`;

// What is shown of one light: its relit tile and what the model adds, black where it would be less.
const SHOWN = `
uniform sampler2D relit;
uniform sampler2D colours;
uniform sampler2D matte;
uniform vec2 origin;
uniform float level;
out vec4 light;
vec3 encode(vec3 l)
{
    if (curve == 1)
        return l;
    vec3 a = abs(l);
    vec3 v = curve == 3 ? pow(a, vec3(1.0 / gamma))
        : mix(1.055 * pow(a, vec3(1.0 / 2.4)) - 0.055, 12.92 * a, lessThanEqual(a, vec3(0.0031308)));
    return sign(l) * v;
}
vec4 model_at(sampler2D model)
{
    return textureLod(model, grain * (gl_FragCoord.xy + origin) / vec2(textureSize(model, 0)), level);
}
`;
const SHOW = `
uniform vec3 towards, rgb;
void show(vec3 more)
{
    vec3 shown = texelFetch(relit, ivec2(gl_FragCoord.xy), 0).rgb;
    light = vec4(max(shown + rgb * more, min(shown, 0.0)), 1.0);
}
`;

// A light whose shadows move: of the matte surface's colour, a and b.
export const shadowShader = () => `${HEAD}${DECODE}${GRAIN}${SHOWN}${SHOW}
uniform sampler2D arrives, reached0, reached1, reached2, reached3;
uniform vec4 captured0, captured1, captured2, captured3;  // direction, weight
// Edges are known to a pixel, and as soft as that.
float soft(sampler2D share)
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    return (5.0 * texelFetch(share, at + 1, 0).r + texelFetch(share, at + ivec2(1, 0), 0).r + texelFetch(share, at + ivec2(0, 1), 0).r +
            texelFetch(share, at + ivec2(2, 1), 0).r + texelFetch(share, at + ivec2(1, 2), 0).r) / 9.0;
}
void main()
{
    vec3 colour = model_at(colours).rgb;
    vec4 m = model_at(matte);
    ${[0, 1, 2, 3].map((i) => `vec3 v${i} = captured${i}.w * encode(colour * soft(reached${i}) * max(m.x + dot(m.yzw, captured${i}.xyz), 0.0));`).join('\n    ')}
    show(colour * soft(arrives) * max(m.x + dot(m.yzw, towards), 0.0) - decode(v0 + v1 + v2 + v3));
}`;

// A light whose highlights move; after viewer/shaders/moving/gloss.frag.glsl.
export const glossShader = () => `${HEAD}${DECODE}${GRAIN}${SHOWN}${SHOW}
uniform sampler2D lights;  // of each captured light: direction, weight
uniform int around;
vec3 gloss_shown(vec4 colour, vec4 pixel, vec3 from)
{
    vec2 xy = vec2(colour.w, pixel.x);
    float z = sqrt(max(1.0 - dot(xy, xy), 1e-6)), cosine = dot(vec3(xy, z), from);
    if (!(cosine > 0.0))
        return vec3(0.0);
    float towards_half = max((cosine + z) / sqrt(max(2.0 + 2.0 * from.z, 1e-6)), 0.0);
    float r = max(pixel.y, 0.05), a2 = r * r * r * r;
    float d = towards_half * towards_half * (a2 - 1.0) + 1.0;
    float lobe = a2 * cosine / (d * d * (cosine + sqrt(a2 + (1.0 - a2) * cosine * cosine)) * (z + sqrt(a2 + (1.0 - a2) * z * z)));
    return min(pixel.z < 0.0 ? colour.rgb * lobe : colour.rgb * cosine + pixel.z * lobe, 1.0);
}
void main()
{
    vec4 colour = model_at(colours), pixel = model_at(matte);
    vec3 between = vec3(0.0);
    for (int i = 0; i < around && pixel.w > 0.0; i++) {
        vec4 from = texelFetch(lights, ivec2(i, 0), 0);
        between += from.w * encode(gloss_shown(colour, pixel, from.xyz));
    }
    show(pixel.w > 0.0 ? pixel.w * (gloss_shown(colour, pixel, towards) - decode(between)) : vec3(0.0));
}`;

// A near light whose shadows move, of one lamp or of 4 x 4 patches; after viewer/shaders/moving/near.frag.glsl.
const MOST_PATCHES = 16;
export const nearShadowShader = (rays) => `${HEAD}${DECODE}${stageShader(rays)}${SHOWN}${ARRIVING}${TRIANGLES}
uniform sampler2D lights;  // of each captured light: direction
uniform vec3 eye;
uniform vec3 lampAt[${MOST_PATCHES}], lampColour[${MOST_PATCHES}];
uniform int lamps;
const int ASKED = 16;      // captured lights that a pixel remembers
ivec2 at;
vec4 m;
int asked[ASKED], remembered;
float answer[ASKED];
float matte_under(vec3 from) { return max(m.x + dot(m.yzw, from), 0.0); }
float know(int index)
{
    for (int i = 0; i < remembered; i++)
        if (asked[i] == index)
            return answer[i];
    vec3 from = texelFetch(lights, ivec2(index, 0), 0).xyz;
    float known = quarters_reached(at, from, BACKGROUND) * matte_under(from);
    if (remembered < ASKED) {
        asked[remembered] = index;
        answer[remembered++] = known;
    }
    return known;
}
void main()
{
    at = ivec2(gl_FragCoord.xy + origin);
    m = model_at(matte);
    remembered = 0;
    vec3 colour = model_at(colours).rgb, relit_ = texelFetch(relit, ivec2(gl_FragCoord.xy), 0).rgb, lit = vec3(0.0), between = vec3(0.0), point;
    bool seen = colour != vec3(0.0) && stage_point(point, min(grain * (vec2(at) + 0.5), vec2(textureSize(surface, 0)) - 0.01));
    for (int i = 0; i < lamps && seen; i++) {
        vec3 towards, weight, codes = vec3(0.0);
        float sent, away = distance(lampAt[i], eye + point);
        ivec3 node;
        if (!sends(towards, sent, lampAt[i], eye + point) || sent <= 0.0)
            continue;
        vec4 from = texture(taken, table_place(towards));
        triangles_find(node, weight, from.xyz);
        for (int k = 0; k < 3; k++)
            if (weight[k] > 0.0)
                codes += weight[k] * encode(colour * know(node[k]));
        float reached = lamps == 1 ? quarters_reached(at, towards, away) : quarter_reached(at, (i + i / 4) & 3, towards, away) ? 1.0 : 0.0;
        vec3 arriving = sent * from.a * lampColour[i];
        lit += arriving * colour * reached * matte_under(normalize(from.xyz));
        between += arriving * decode(codes);
    }
    vec3 rest = relit_ - between;
    light = vec4(max((RAYS >= CYLINDER ? max(rest, 0.0) : rest) + lit, min(relit_, 0.0)), 1.0);
}`;
