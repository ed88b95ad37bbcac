// What all models share: a pixel of the surface, the lamp of the pass, and the measured directions
// around any direction. Before it: view_grid and light_grid (struct relume_btf_model); after it:
// model_eval, or, where OWN_BLEND is defined, model_blend.
uniform sampler2D place, normal_s, tangent_t;  // btf_surface.frag
uniform int part;                              // that is drawn
uniform vec4 eye;                              // its place, 1; or the direction towards it, 0
uniform ivec2 texels;                          // of a repeat
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
    float rim;
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

// Twin: relume_dome_at. A cell lists the triangles that directions in it can meet, each as six
// texels: for each corner the vector along which its weight grows and its number (-1: the nadir),
// then where the corners are.
Blend dome_at(isamplerBuffer cells, samplerBuffer triangles, vec3 d)
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
    Blend b = Blend(ivec3(max(number, 0.0)), weight, d, 1.0);
    if (real != vec3(1.0)) {
        b.direction = normalize(weight.x * texelFetch(triangles, 6 * found + 3).xyz +
                                weight.y * texelFetch(triangles, 6 * found + 4).xyz +
                                weight.z * texelFetch(triangles, 6 * found + 5).xyz);
        b.rim = min(max(d.z, 0.0) / b.direction.z, 1.0);
    }
    return b;
}

// ---------------------------------------------------------------- the model

// Twin: vec3_upright. Turned by the shortest way that brings `n` to +z.
vec3 upright(vec3 a, vec3 n)
{
    vec3 middle = vec3(n.xy, n.z + 1.0);
    vec3 b = a - middle * (dot(a, middle) / (1.0 + n.z));
    return vec3(b.xy, b.z + 2.0 * dot(n, a));
}

#ifdef OWN_BLEND
vec3 model_blend(int texel, Blend v, Blend l);
#else
// At one texel, at a measured view (light) where the model is gridded over them.
vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l);

// Twin: model_blend.
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

// Twin: relume_btf_fitted_sample.
vec3 btf_sample(vec2 at, Blend v, Blend l)
{
    vec2 corner = floor(bilinear ? at - 0.5 : at);
    vec2 part_of = bilinear ? at - 0.5 - corner : vec2(0.0);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < (bilinear ? 4 : 1); i++) {
        vec2 step_to = vec2(i & 1, i >> 1);
        vec2 share = mix(1.0 - part_of, part_of, step_to);
        vec2 inside = corner + step_to - vec2(texels) * floor((corner + step_to) / vec2(texels));
        ivec2 texel = min(ivec2(inside), texels - 1);
        sum += share.x * share.y * model_blend(texel_of(texel), v, l);
    }
    return sum;
}

// ---------------------------------------------------------------- the lamp

// Twin: relume_lamp_at. A facet's place and normal are those of the light.
bool lamp_at(out vec3 towards, out vec3 rgb, vec3 point)
{
    if (light.kind == DIRECTIONAL) {
        towards = light.axis;
        rgb = light.rgb;
        return true;
    }
    if (light.kind != AREA)
        return light_at(towards, rgb, point);
    float distance;
    bool arrives = ray_to(towards, distance, light.position, point);
    float cosine = -dot(towards, light.axis);
    rgb = light.rgb * cosine / (distance * distance);
    return arrives && cosine > 0.0;
}

// Twin: objects_shade.
void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 at = texelFetch(place, pixel, 0);
    if (int(abs(at.w)) != part + 1)
        discard;
    vec3 towards, arriving;
    if (!lamp_at(towards, arriving, at.xyz))
        discard;
    vec4 ns = texelFetch(normal_s, pixel, 0), tt = texelFetch(tangent_t, pixel, 0);
    mat3 frame = mat3(tt.xyz, sign(at.w) * cross(ns.xyz, tt.xyz), ns.xyz);
    vec3 l = towards * frame;
    if (l.z <= 0.0)
        discard;
    float seen = reached(at.xyz, ns.xyz);
    if (seen <= 0.0)
        discard;
    vec3 v = normalize(eye.xyz - eye.w * at.xyz) * frame;
    v = normalize(vec3(v.xy, max(v.z, 1e-3)));
    l = normalize(l);
    Blend by_light = dome_at(light_cells, light_triangles, l);
    vec3 value = btf_sample(vec2(ns.w, tt.w) * vec2(texels),
                            dome_at(view_cells, view_triangles, v), by_light);
    color = vec4(arriving * seen * (without_cosine ? l.z : by_light.rim) * value, 1.0);
}
