// What all models share: a pixel of the surface, the light sample of the draw, measured directions
// around any direction. Before it: view_grid and light_grid (struct relume_btf_model); after it:
// model_eval, or, where OWN_BLEND is defined, model_blend; where LOBES is, also model_lit; where
// OWN_PLACES is, also model_at, which knows what lies between texels.
//
// Compiled twice: for light samples, and with SKY defined for an environment. Each level of detail
// is a draw of its own, which adds its part of what lies between two levels.
#include "texels.glsl"
#include "shared/cube.glsl"
#include "light/light.glsl"
#include "light_sample.glsl"
#include "shadow.glsl"
#include "sky.glsl"

uniform sampler2D place, normal_s, tangent_t, footprint;  // btf_surface.frag
uniform int part;                              // that is drawn
uniform vec4 eye;                              // its place, 1; or the direction towards it, 0
uniform ivec2 texels;                          // of a repeat, on this level
uniform ivec2 finest;                          // the same of the first level
uniform int level, levels;
uniform int area;                              // texels of the sample
uniform ivec4 map;                             // columns, rows; width, height of a tile; 0: none
uniform usamplerBuffer map_texels;             // the matrix of tiles, then their texels
uniform bool bilinear, without_cosine;
uniform ivec4 counts;  // views, lights, components, lobes
uniform isamplerBuffer view_cells, light_cells;
uniform samplerBuffer view_triangles, light_triangles;
out vec4 color;

// ---------------------------------------------------------------- directions

struct Blend {
    ivec3 index;
    vec3 weight;
    vec3 direction;
    float rim, size;  // relume_direction_blend.length
};

const int CELLS = 32;  // along each side of the octahedral map

int cell_of(vec3 d)
{
    vec2 p = d.xy / (abs(d.x) + abs(d.y) + abs(d.z));
    if (d.z < 0.0)
        p = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    ivec2 at = clamp(ivec2((0.5 * p + 0.5) * float(CELLS)), ivec2(0), ivec2(CELLS - 1));
    return at.y * CELLS + at.x;
}

// Twin: relume_direction_mesh_at. A cell lists the triangles that directions in it can point into,
// each as six texels: for each corner the vector along which its weight grows and its number (-1:
// the nadir), then where the corners are.
Blend mesh_at(isamplerBuffer cells, samplerBuffer triangles, vec3 d)
{
    ivec2 list = texelFetch(cells, cell_of(d)).xy;
    vec3 best = vec3(1.0, 0.0, 0.0);
    float most = -1e9;
    int found = list.x;
    for (int i = list.x; i < list.x + list.y; i++) {
        vec3 w = vec3(dot(d, texelFetch(triangles, 6 * i).xyz),
                      dot(d, texelFetch(triangles, 6 * i + 1).xyz),
                      dot(d, texelFetch(triangles, 6 * i + 2).xyz));
        float sum = w.x + w.y + w.z;
        if (sum <= 1e-12)
            continue;
        w /= sum;
        float least = min(w.x, min(w.y, w.z));
        if (least > most) {
            most = least;
            found = i;
            best = w;
        }
    }
    vec3 number = vec3(texelFetch(triangles, 6 * found).w, texelFetch(triangles, 6 * found + 1).w,
                       texelFetch(triangles, 6 * found + 2).w);
    vec3 real = step(vec3(0.0), number);
    vec3 weight = max(best, 0.0) * real;
    float sum = weight.x + weight.y + weight.z;
    weight = sum > 1e-9 ? weight / sum : real / (real.x + real.y + real.z);
    vec3 middle = weight.x * texelFetch(triangles, 6 * found + 3).xyz +
                  weight.y * texelFetch(triangles, 6 * found + 4).xyz +
                  weight.z * texelFetch(triangles, 6 * found + 5).xyz;
    Blend b = Blend(ivec3(max(number, 0.0)), weight, d, 1.0, length(middle));
    if (real != vec3(1.0)) {
        b.direction = normalize(middle);
        b.rim = min(max(d.z, 0.0) / b.direction.z, 1.0);
    }
    return b;
}

// ---------------------------------------------------------------- the model

#ifdef OWN_BLEND
vec3 model_blend(int texel, Blend v, Blend l);
#else
// At one texel, at a measured view (light) where the model is gridded over them.
vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l);

// Twin: model_blend of model.c.
vec3 model_blend(int texel, Blend v, Blend l)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < (view_grid ? 3 : 1); i++)
        for (int j = 0; j < (light_grid ? 3 : 1); j++) {
            float weight = (view_grid ? v.weight[i] : 1.0) * (light_grid ? l.weight[j] : 1.0);
            if (weight > 0.0)
                sum += weight * model_eval(texel, v.index[i], l.index[j], v.direction, l.direction);
        }
    return sum;
}
#endif

// A place between the texels under the light of the draw.
#if defined(SKY) && defined(LOBES)
vec3 model_lit(int texel, int view, vec3 v, mat3 frame);

vec3 value_at(int texel, Blend v, Blend l, mat3 frame)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < (view_grid ? 3 : 1); i++) {
        float weight = view_grid ? v.weight[i] : 1.0;
        if (weight > 0.0)
            sum += weight * model_lit(texel, v.index[i], v.direction, frame);
    }
    return sum;
}
#else
vec3 value_at(int texel, Blend v, Blend l, mat3 frame)
{
    return max(model_blend(texel, v, l), 0.0);
}
#endif

// Twin: relume_btf_surface_evaluate. The texel of the sample that stands there.
int texel_of(ivec2 at)
{
    if (map.x == 0)
        return at.y * texels.x + at.x;
    ivec2 tile = at / map.zw, inside = at - tile * map.zw;
    int number = int(texelFetch(map_texels, tile.y * map.x + tile.x).r);
    return int(texelFetch(map_texels,
                          map.x * map.y + (number * map.w + inside.y) * map.z + inside.x).r);
}

#ifdef OWN_PLACES
vec3 model_at(vec2 at, Blend v, Blend l);
#endif

// Twin: add_level.
vec3 btf_sample(vec2 at, Blend v, Blend l, mat3 frame)
{
#ifdef OWN_PLACES
    if (map.x == 0)
        return max(model_at(at, v, l), 0.0);
#endif
    vec2 corner = floor(bilinear ? at - 0.5 : at);
    vec2 part_of = bilinear ? at - 0.5 - corner : vec2(0.0);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < (bilinear ? 4 : 1); i++) {
        vec2 step_to = vec2(i & 1, i >> 1);
        vec2 share = mix(1.0 - part_of, part_of, step_to);
        vec2 inside = corner + step_to - vec2(texels) * floor((corner + step_to) / vec2(texels));
        ivec2 texel = min(ivec2(inside), texels - 1);
        sum += share.x * share.y * value_at(texel_of(texel), v, l, frame);
    }
    return sum;
}

// What a pixel covers: lookups along a line, and what of their level this one has.
struct Points {
    vec2 at, way;  // texels of this level; from lookup to lookup
    int aside;     // lookups on either side of the middle
    float ratio;   // how many lookups all of them count as
    float weight;
};

const float SQUARE = 0.0625, MOST_RATIO = 7.0;

// Twins: relume_btf_surface_filter and add_point of src/material/surface/surface.c.
Points points_of(vec2 texture_at, vec4 spread)
{
    if (!bilinear)
        return Points((floor(texture_at * vec2(texels)) + 0.5), vec2(0.0), 0, 1.0,
                      level == 0 ? 1.0 : 0.0);
    vec2 right = spread.xy * vec2(finest), down = spread.zw * vec2(finest);
    float longer = max(length(right), length(down));
    float shorter = max(min(length(right), length(down)), 1.0);
    float ratio = clamp(longer / shorter - SQUARE, 1.0, MOST_RATIO);
    float at = min(log2(max(longer / ratio, 1.0)), float(levels - 1));
    vec2 way = (length(right) > length(down) ? right : down) *
               max(shorter / max(longer, 1.0), 1.0 / MOST_RATIO);
    return Points(texture_at * vec2(texels), way * vec2(texels) / vec2(finest),
                  int(ceil(0.5 * (ratio - 1.0))), ratio, max(1.0 - abs(at - float(level)), 0.0));
}

vec3 mean_of(Points p, Blend v, Blend l, mat3 frame)
{
    vec3 sum = vec3(0.0);
    for (int i = -p.aside; i <= p.aside; i++) {
        float share = clamp(0.5 * (p.ratio + 1.0) - abs(float(i)), 0.0, 1.0);
        sum += share * btf_sample(p.at + float(i) * p.way, v, l, frame);
    }
    return p.weight * sum / p.ratio;
}

// ---------------------------------------------------------------- the light

#ifdef SKY

#ifndef LOBES
uniform ivec2 some_lights;  // the draw sums over these: from, to
#endif

// Without shadows. Twin: add_sky.
vec3 lit(vec3 point, vec3 normal, Points p, Blend v, mat3 frame)
{
#ifdef LOBES
    return mean_of(p, v, v, frame);
#else
    vec3 sum = vec3(0.0);
    for (int i = some_lights.x; i < some_lights.y; i++) {
        vec3 direction;
        vec3 weight = sky_weight(frame, i, direction);
        sum += weight * mean_of(p, v, Blend(ivec3(i), vec3(1.0, 0.0, 0.0), direction, 1.0, 1.0), frame);
    }
    return sum;
#endif
}

#else

// Twin: add_sample of world/object/render.c.
vec3 lit(vec3 point, vec3 normal, Points p, Blend v, mat3 frame)
{
    vec3 towards, arriving;
    if (!sample_at(towards, arriving, point))
        return vec3(0.0);
    vec3 l = towards * frame;
    if (l.z <= 0.0)
        return vec3(0.0);
    float seen = reached(point, normal);
    if (seen <= 0.0)
        return vec3(0.0);
    l = normalize(l);
    Blend by_light = mesh_at(light_cells, light_triangles, l);
    float scale = without_cosine ? l.z : by_light.rim / (light_grid ? by_light.size : 1.0);
    return arriving * seen * scale * mean_of(p, v, by_light, frame);
}

#endif

// Twin: objects_shade of world/object/render.c.
void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 at = texelFetch(place, pixel, 0);
    if (int(abs(at.w)) != part + 1)
        discard;
    vec4 ns = texelFetch(normal_s, pixel, 0), tt = texelFetch(tangent_t, pixel, 0);
    Points p = points_of(vec2(ns.w, tt.w), texelFetch(footprint, pixel, 0));
    if (p.weight <= 0.0)
        discard;
    mat3 frame = mat3(tt.xyz, sign(at.w) * cross(ns.xyz, tt.xyz), ns.xyz);
    vec3 v = normalize(eye.xyz - eye.w * at.xyz) * frame;
    v = normalize(vec3(v.xy, max(v.z, 1e-3)));
    color = vec4(lit(at.xyz, ns.xyz, p, mesh_at(view_cells, view_triangles, v), frame), 1.0);
}
