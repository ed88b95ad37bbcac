// shaders.js - what the graphics card computes; twins of viewer/shaders and src/
//
// Rows of textures run down the picture, those of frames up.

export const HEAD = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
`;

export const LUMINANCE = 'const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);\n';

// Codes to linear light; odd, as relume_transfer_decode.
export const DECODE = `
uniform int curve;
uniform float gamma;
vec3 decode(vec3 v)
{
    if (curve == 1)
        return v;
    vec3 a = abs(v);
    vec3 l = curve == 3 ? pow(a, vec3(gamma))
        : mix(pow((a + 0.055) / 1.055, vec3(2.4)), a / 12.92, lessThanEqual(a, vec3(0.04045)));
    return sign(v) * l;
}
`;

// Of one light: three weights a layer, for its R, G and B, then the constant, then its colour (of
// normals: its direction), then, where planes have a guide (src/site/publish/guide.h), what is added to their sum.
export const MOST_LIGHTS = 16;
export const MOST_SAMPLES = 20;
export const strideOf = (layers, guide) => 3 * layers + (guide ? 3 : 2);

// What the sum of a pixel's planes counts, by the code of the first.
export function guideGain(guide, code) {
    const [scale, offset, knee] = (guide || []).map((v) => v.toExponential());
    return guide ? `(${knee} + abs(${scale} * ${code} + (${offset})))` : '1.0';
}

const weightsBlock = (layers, guide, lights) => `
const int LAYERS = ${layers};
const int STRIDE = ${strideOf(layers, guide)};
uniform sampler2DArray codes;
layout(std140) uniform Weights { vec4 weight[${strideOf(layers, guide) * lights}]; };
uniform int lights;
vec3 code[LAYERS];
void fetch()
{
    for (int j = 0; j < LAYERS; j++)
        code[j] = texelFetch(codes, ivec3(gl_FragCoord.xy, j), 0).rgb;
}
vec3 value(int light)
{
    int w = light * STRIDE;
    vec3 v = ${guide ? 'weight[w + 3 * LAYERS + 2].rgb' : 'vec3(0.0)'};
    for (int j = 0; j < LAYERS; j++)
        v += code[j].r * weight[w + 3 * j].rgb + code[j].g * weight[w + 3 * j + 1].rgb +
             code[j].b * weight[w + 3 * j + 2].rgb;
    return weight[w + 3 * LAYERS].rgb + ${guideGain(guide, 'code[0].r')} * v;
}
`;

// One tile under `count` lights: each decoded by itself, then added in linear light. Written out, since
// software renderers look up what an index is computed for pixel by pixel.
export function relightShader(layers, guide, count) {
    const stride = strideOf(layers, guide), each = Array.from({ length: layers }, (_, j) => j);
    const planes = (w) => each.flatMap((j) => ['r', 'g', 'b'].map((c, k) => `code${j}.${c} * weight[${w + 3 * j + k}].rgb`)).join(' + ');
    const value = (w) => `weight[${w + 3 * layers}].rgb + ${guide ? `gain * (weight[${w + 3 * layers + 2}].rgb + ${planes(w)})` : planes(w)}`;
    return `${HEAD}${DECODE}
uniform sampler2DArray codes;
layout(std140) uniform Weights { vec4 weight[${stride * count}]; };
out vec4 colour;
void main()
{
    vec3 sum = vec3(0.0);
    ${each.map((j) => `vec3 code${j} = texelFetch(codes, ivec3(gl_FragCoord.xy, ${j}), 0).rgb;`).join('\n    ')}
    float gain = ${guideGain(guide, 'code0.r')};
    ${Array.from({ length: count }, (_, i) => `sum += weight[${i * stride + 3 * layers + 1}].rgb * decode(${value(i * stride)});`).join('\n    ')}
    colour = vec4(sum, 1.0);
}`;
}

// Normals and albedo of a tile by robust photometric stereo; after src/core/math/lambert.c.
export const normalShader = (layers, guide, samples) => `${HEAD}${LUMINANCE}${DECODE}${weightsBlock(layers, guide, samples)}
layout(location = 0) out vec4 normal;
layout(location = 1) out vec4 albedo;
const int ROUNDS = 5;
float sampled[${samples}], share[${samples}];

vec3 direction(int i) { return weight[i * STRIDE + 3 * LAYERS + 1].xyz; }

bool solve(out vec3 g)
{
    mat3 m = mat3(0.0);
    vec3 b = vec3(0.0);
    for (int i = 0; i < lights; i++) {
        vec3 l = direction(i);
        m += share[i] * outerProduct(l, l);
        b += share[i] * sampled[i] * l;
    }
    float size = m[0][0] + m[1][1] + m[2][2];
    float determinantOf = determinant(m);
    if (!(determinantOf > 1e-6 * size * size * size))
        return false;
    g = inverse(m) * b;
    return true;
}

// The ends of the samples, shadows and highlights, are cut off.
void trim()
{
    int dark = lights / 4, bright = lights / 10;
    for (int i = 0; i < lights; i++) {
        int rank = 0;
        for (int j = 0; j < lights; j++)
            rank += sampled[j] < sampled[i] || (sampled[j] == sampled[i] && j < i) ? 1 : 0;
        share[i] = rank >= dark && rank < lights - bright ? 1.0 : 0.0;
    }
}

// Cauchy's weights; the scale is that of the mean absolute residual.
void weigh(vec3 g)
{
    float sum = 0.0, norm = 0.0, size = length(g);
    for (int i = 0; i < lights; i++) {
        sum += share[i] * abs(sampled[i] - dot(g, direction(i)));
        norm += share[i];
    }
    float scale = 2.385 * max(1.25 * sum / max(norm, 1e-6), 1e-4 * size);
    for (int i = 0; i < lights; i++) {
        float expected = dot(g, direction(i)), r = (sampled[i] - expected) / scale;
        share[i] = expected > 0.05 * size ? 1.0 / (1.0 + r * r) : 0.0;
    }
}

void main()
{
    vec3 g, better, sum = vec3(0.0);
    float norm = 0.0;
    fetch();
    for (int i = 0; i < lights; i++)
        sampled[i] = dot(decode(value(i)), LUMINANCE);
    trim();
    normal = albedo = vec4(0.0);
    if (!solve(g) || !(length(g) > 1e-3))
        return;
    for (int round = 0; round < ROUNDS; round++) {
        weigh(g);
        if (solve(better))
            g = better;
    }
    vec3 n = normalize(g);
    for (int i = 0; i < lights; i++) {
        float cosine = dot(n, direction(i));
        if (cosine <= 0.05)
            continue;
        norm += share[i] * cosine * cosine;
        sum += share[i] * cosine * decode(value(i));
    }
    normal = vec4(n, 1.0);
    albedo = vec4(norm > 0.0 ? max(sum / norm, 0.0) : vec3(0.0), 1.0);
}`;

// A tile into a frame: bilinear in linear light, the mean of four places where texels are smaller than
// pixels.
export const tileShader = () => `${HEAD}
uniform sampler2D tile;
uniform vec2 step_;  // texels of the tile a pixel, over its size
uniform float several;
in vec2 place;
out vec4 colour;
void main()
{
    colour = texture(tile, place);
    if (several > 0.5)
        colour = 0.25 * (texture(tile, place + 0.25 * step_) + texture(tile, place - 0.25 * step_) +
                         texture(tile, place + vec2(0.25, -0.25) * step_) +
                         texture(tile, place - vec2(0.25, -0.25) * step_));
}`;

// What lies outside a mask is not there.
export const maskShader = () => `${HEAD}
uniform sampler2D mask;
in vec2 place;
out vec4 colour;
void main()
{
    colour = vec4(texture(mask, place).r);
}`;

// ---------------------------------------------------------------- slabs

const FOOTPRINT = `
struct Footprint { int count; float step_; };
Footprint footprint_of(float texels)
{
    if (!(texels > 1.25))
        return Footprint(1, 0.0);
    float r = texels < 2.0 ? 1.0 + (texels - 1.25) / 0.75 : texels;
    float whole = clamp(ceil(r - 1e-4), 2.0, 16.0);
    return Footprint(int(whole), sqrt((r * r - 1.0) / (whole * whole - 1.0)) / texels);
}
float footprint_place(Footprint f, int i) { return (float(i) - 0.5 * float(f.count - 1)) * f.step_; }
`;

// One cell of a slab between four cameras, each where it sees the surface of the ray; after
// viewer/shaders/slab_depth.glsl and slab_cell.glsl, cameras by number: low u low v, high u low v, ...
export const slabShader = (byDepth) => `${HEAD}${FOOTPRINT}
uniform sampler2DArray views;
uniform sampler2DArray disparities;
uniform vec4 slot;     // of the cameras in these
uniform vec4 picture;  // left, top, right, bottom of the window in the frame, rows counted down
uniform vec2 frame;    // its size
uniform vec3 eye;      // x, y, and how far towards the st plane the uv plane lies
uniform vec4 st;
uniform vec4 cell;
uniform vec4 grid;
uniform vec2 range;
out vec4 colour;
const float BACKGROUND = -1.0;
vec2 size, texel, shift[4];
float share[4];

vec2 window_place(vec2 within)
{
    vec2 at = vec2(gl_FragCoord.x, frame.y - gl_FragCoord.y) + within;
    return (at - picture.xy) / (picture.zw - picture.xy);
}
vec2 slab_uv(vec2 at)
{
    vec2 hit = vec2(mix(st.x, st.z, at.x), mix(st.w, st.y, at.y));
    return eye.xy + eye.z * (hit - eye.xy);
}
bool inside(vec2 at) { return all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, size)); }

#if ${byDepth ? 1 : 0}
float disparity_at(int c, float q)
{
    vec2 at = texel + q * shift[c];
    if (!inside(at))
        return BACKGROUND;
    return texelFetch(disparities, ivec3(clamp(ivec2(floor(at)), ivec2(0), ivec2(size) - 1), int(slot[c])), 0).r;
}

// Sums of rgb, disparity and weight.
struct Sum { vec4 rgba; float disparity, weight; };
void gather(inout Sum sum, int c, float q, float surface, float speed)
{
    vec2 at = texel + q * shift[c];
    if (!inside(at) || share[c] <= 0.0)
        return;
    ivec2 corner = ivec2(floor(at - 0.5));
    vec2 scale = vec2(textureSize(views, 0).xy) / size;
    for (int k = 0; k < 4; k++) {
        ivec2 here = corner + ivec2(k & 1, k >> 1);
        vec2 part = 1.0 - abs(at - 0.5 - vec2(here));
        ivec2 within = clamp(here, ivec2(0), ivec2(size) - 1);
        float found = texelFetch(disparities, ivec3(within, int(slot[c])), 0).r;
        float agreement = clamp(2.0 - abs(surface - found) * speed * length(shift[c]), 0.0, 1.0);
        float w = share[c] * part.x * part.y * agreement;
        sum.rgba += w * texelFetch(views, ivec3((vec2(within) + 0.5) * scale, int(slot[c])), 0);
        sum.disparity += w * found;
        sum.weight += w;
    }
}
bool gather_all(out Sum sum, float q, float surface, float speed)
{
    sum = Sum(vec4(0.0), 0.0, 0.0);
    for (int c = 0; c < 4; c++)
        gather(sum, c, q, surface, speed);
    return sum.weight > 1e-6;
}

bool walk(out float q, float from, float to)
{
    float pace = 0.0;
    for (int c = 0; c < 4; c++)
        pace = max(pace, share[c] > 1e-4 ? length(shift[c]) : 0.0);
    int steps = clamp(int(ceil(abs(from - to) * pace)), 1, 256);
    float step_ = (from - to) / float(steps);
    for (int k = 0; k <= steps; k++) {
        float at = from - float(k) * step_;
        vec2 sum = vec2(0.0);
        for (int c = 0; c < 4; c++) {
            float found = disparity_at(c, at);
            if (share[c] > 1e-4 && found > BACKGROUND && abs(found - at) <= step_)
                sum += share[c] * vec2(found, 1.0);
        }
        if (sum.y > 0.0) {
            q = sum.x / sum.y;
            return true;
        }
    }
    return false;
}

vec4 ray_value()
{
    Sum sum;
    float q = 0.0;
    bool seen = false;
    if (range.y >= range.x && walk(q, range.y, range.x)) {
        for (int round = 0; round < 2 && gather_all(sum, q, q, 1.0); round++)
            q = sum.disparity / sum.weight;
        seen = gather_all(sum, q, q, 1.0);
    }
    if (!seen)
        seen = gather_all(sum, 0.0, BACKGROUND, 1.0);
    if (!seen)
        gather_all(sum, 0.0, 0.0, 0.0);
    return sum.weight > 0.0 ? sum.rgba / sum.weight : vec4(0.0);
}
#else
vec4 ray_value()
{
    vec4 sum = vec4(0.0);
    for (int c = 0; c < 4; c++)
        sum += share[c] * texture(views, vec3(texel / size, slot[c]));
    return sum;
}
#endif

vec4 value_at(vec2 within)
{
    vec2 at = window_place(within), uv = slab_uv(at);
    vec2 part = clamp((uv - cell.xy) / max(cell.zw - cell.xy, vec2(1e-30)), 0.0, 1.0);
    texel = at * size;
    for (int c = 0; c < 4; c++) {
        bvec2 high = bvec2((c & 1) != 0, c >> 1 != 0);
        vec2 camera = mix(cell.xy, cell.zw, vec2(high));
        vec2 w = mix(1.0 - part, part, vec2(high));
        shift[c] = (uv - camera) * size / (st.zw - st.xy) * vec2(1.0, -1.0);
        share[c] = w.x * w.y;
    }
    return ray_value();
}

void main()
{
    vec2 at = window_place(vec2(0.0)), uv = clamp(slab_uv(at), grid.xy, grid.zw);
    bvec2 last = greaterThanEqual(cell.zw, grid.zw);
    bool here = all(greaterThanEqual(uv, cell.xy)) && (uv.x < cell.z || last.x) && (uv.y < cell.w || last.y);
    if (!here || any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0))))
        discard;
    size = vec2(textureSize(${byDepth ? 'disparities' : 'views'}, 0).xy);
    vec2 texels = size / (picture.zw - picture.xy);
    Footprint across = footprint_of(texels.x), down = footprint_of(texels.y);
    vec4 sum = vec4(0.0);
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++)
            sum += value_at(vec2(footprint_place(across, i), footprint_place(down, j)));
    colour = sum / float(across.count * down.count);
}`;

// What one camera adds to a frame through a wide lens; after viewer/shaders/slab_lens.frag.glsl.
export const lensShader = () => `${HEAD}
uniform sampler2DArray views;
uniform float layer;
uniform vec4 picture, st, grid;
uniform vec2 frame, camera, lens;  // lens: radius, disparity in focus
uniform vec4 steps;                // to the lines of the grid beside the camera: u below, u above, v
uniform vec3 eye;
out vec4 colour;
float hat(float away, vec2 step_) { return max(1.0 - abs(away) / (away > 0.0 ? step_.y : step_.x), 0.0); }
void main()
{
    vec2 at = (vec2(gl_FragCoord.x, frame.y - gl_FragCoord.y) - picture.xy) / (picture.zw - picture.xy);
    if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0))))
        discard;
    vec2 hit = vec2(mix(st.x, st.z, at.x), mix(st.w, st.y, at.y));
    vec2 uv = eye.xy + eye.z * (hit - eye.xy);
    vec2 away = clamp(uv, grid.xy, grid.zw) - camera;
    float distant = length(away), left = distant > lens.x ? 1.0 - lens.x / distant : 0.0;
    float w = hat(left * away.x, steps.xy) * hat(left * away.y, steps.zw);
    vec2 from = at + lens.y * (uv - camera) / (st.zw - st.xy) * vec2(1.0, -1.0);
    if (any(lessThan(from, vec2(0.0))) || any(greaterThan(from, vec2(1.0))))
        w = 0.0;
    colour = vec4(w * texture(views, vec3(from, layer)).rgb, w);
}`;

// ---------------------------------------------------------------- panoramas

const LAYOUTS = {
    cylindrical: `
bool pixel_of(out vec2 xy, out int face, vec3 d)
{
    face = 0;
    float h = d.y / length(d.xz);
    xy = vec2(azimuth_column(d), (elevation.y - h) / (elevation.y - elevation.x) * size.y);
    return h >= elevation.x && h <= elevation.y;
}
float texels_of(vec3 d, vec3 move)
{
    float square = dot(d.xz, d.xz), h = d.y / sqrt(square);
    float turn = (d.x * move.z - d.z * move.x) / square;
    float rise = move.y / sqrt(square) - h * dot(d.xz, move.xz) / square;
    return length(vec2(turn * size.x / (2.0 * PI), rise * size.y / (elevation.y - elevation.x)));
}
vec4 texel_at(int face, ivec2 at)
{
    ivec2 most = ivec2(size);
    return fetch(ivec2(wrap_index(at.x, most.x), clamp(at.y, 0, most.y - 1)));
}`,
    discs: `
uniform float disc;  // side of a disc's square in the rows below the cylinder
float rows() { return size.y - disc; }
vec4 cylinder_texel(ivec2 at)
{
    return fetch(ivec2(wrap_index(at.x, int(size.x)), clamp(at.y, 0, int(rows()) - 1)));
}
vec4 cylinder_bilinear(vec2 position)
{
    ivec2 at = ivec2(floor(position));
    vec2 part = position - vec2(at);
    return mix(mix(cylinder_texel(at), cylinder_texel(at + ivec2(1, 0)), part.x),
               mix(cylinder_texel(at + ivec2(0, 1)), cylinder_texel(at + 1), part.x), part.y);
}
float height_of(bool lower) { return lower ? elevation.x : elevation.y; }
vec3 square_ray(bool lower, vec2 position)
{
    float right = 2.0 * position.x / disc - 1.0, up = 1.0 - 2.0 * position.y / disc;
    return vec3(right, height_of(lower), lower ? -up : up);
}
vec2 square_pixel(bool lower, vec3 d)
{
    return (0.5 + 0.5 * height_of(lower) / d.y * vec2(d.x, lower ? d.z : -d.z)) * disc;
}
vec2 cylinder_position(vec3 d, float h)
{
    return vec2(azimuth_column(d), (elevation.y - h) / (elevation.y - elevation.x) * rows());
}
vec4 disc_texel(bool lower, ivec2 at)
{
    vec3 d = square_ray(lower, vec2(at) + 0.5);
    if (dot(d.xz, d.xz) > 1.0)
        return cylinder_bilinear(cylinder_position(d, d.y / length(d.xz)) - 0.5);
    return fetch(ivec2(lower ? int(disc) + at.x : at.x, int(rows()) + at.y));
}
vec4 disc_value(bool lower, vec2 position)
{
    ivec2 at = ivec2(floor(position - 0.5));
    vec2 part = position - 0.5 - vec2(at);
    return mix(mix(disc_texel(lower, at), disc_texel(lower, at + ivec2(1, 0)), part.x),
               mix(disc_texel(lower, at + ivec2(0, 1)), disc_texel(lower, at + 1), part.x), part.y);
}
float texels_of(vec3 d, vec3 move)
{
    float square = dot(d.xz, d.xz), h = d.y / sqrt(square);
    if (!(h >= elevation.x && h <= elevation.y))
        return length(0.5 * disc * height_of(d.y < 0.0) / d.y * (move.xz - move.y / d.y * d.xz));
    float turn = (d.x * move.z - d.z * move.x) / square;
    float rise = move.y / sqrt(square) - h * dot(d.xz, move.xz) / square;
    return length(vec2(turn * size.x / (2.0 * PI), rise * rows() / (elevation.y - elevation.x)));
}
vec4 sample_at(vec3 d)
{
    float h = d.y / length(d.xz);
    bool lower = d.y < 0.0;
    if (!(h >= elevation.x && h <= elevation.y))
        return disc_value(lower, square_pixel(lower, d));
    vec2 xy = cylinder_position(d, h);
    float from_rim = min(xy.y, rows() - xy.y);
    if (from_rim >= 0.5)
        return cylinder_bilinear(xy - 0.5);
    vec3 at = vec3(d.xz / length(d.xz), height_of(lower)).xzy;
    vec4 row = cylinder_bilinear(vec2(xy.x - 0.5, lower ? rows() - 1.0 : 0.0));
    return mix(disc_value(lower, square_pixel(lower, at)), row, 2.0 * from_rim);
}`,
    spherical: `
bool pixel_of(out vec2 xy, out int face, vec3 d)
{
    face = 0;
    xy = vec2(azimuth_column(d), (0.5 - atan(d.y, length(d.xz)) / PI) * size.y);
    return true;
}
float texels_of(vec3 d, vec3 move)
{
    return length(cross(d, move)) / dot(d, d) * max(size.x / (2.0 * PI), size.y / PI);
}
vec4 texel_at(int face, ivec2 at)
{
    ivec2 most = ivec2(size);
    int column = wrap_index(at.x, most.x);
    if (at.y >= 0 && at.y < most.y)
        return fetch(ivec2(column, at.y));
    int row = clamp(at.y, 0, most.y - 1);
    return 0.5 * (fetch(ivec2(wrap_index(column + most.x / 2, most.x), row)) +
                  fetch(ivec2(wrap_index(column + (most.x + 1) / 2, most.x), row)));
}`,
    cube: `
const vec3 AHEAD[6] = vec3[6](vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1));
const vec3 RIGHT[6] = vec3[6](vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0), vec3(1, 0, 0), vec3(-1, 0, 0), vec3(1, 0, 0));
const vec3 UP[6] = vec3[6](vec3(0, 1, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(0, 0, -1), vec3(0, 1, 0), vec3(0, 1, 0));
int face_of(vec3 d)
{
    vec3 a = abs(d);
    if (a.x >= a.y && a.x >= a.z)
        return d.x >= 0.0 ? 0 : 1;
    if (a.y >= a.z)
        return d.y >= 0.0 ? 2 : 3;
    return d.z >= 0.0 ? 4 : 5;
}
bool pixel_of(out vec2 xy, out int face, vec3 d)
{
    face = face_of(d);
    xy = (0.5 + 0.5 * vec2(dot(d, RIGHT[face]), -dot(d, UP[face])) / dot(d, AHEAD[face])) * size.y;
    return true;
}
float texels_of(vec3 d, vec3 move)
{
    int face = face_of(d);
    float ahead = dot(d, AHEAD[face]);
    vec3 beside = move - dot(move, AHEAD[face]) / ahead * d;
    return 0.5 * size.y * length(vec2(dot(beside, RIGHT[face]), dot(beside, UP[face]))) / ahead;
}
vec4 across_edge(int face, ivec2 at)
{
    vec2 ab = vec2(2.0 * (float(at.x) + 0.5) / size.y - 1.0, 1.0 - 2.0 * (float(at.y) + 0.5) / size.y), xy;
    int other, side = int(size.y);
    pixel_of(xy, other, AHEAD[face] + ab.x * RIGHT[face] + ab.y * UP[face]);
    return fetch(ivec2(other * side, 0) + clamp(ivec2(xy), ivec2(0), ivec2(side - 1)));
}
vec4 texel_at(int face, ivec2 at)
{
    int side = int(size.y);
    ivec2 inner = clamp(at, ivec2(0), ivec2(side - 1));
    vec4 own = fetch(ivec2(face * side, 0) + inner);
    if (at == inner)
        return own;
    if (at.x == inner.x || at.y == inner.y)
        return across_edge(face, at);
    return (own + across_edge(face, ivec2(at.x, inner.y)) + across_edge(face, ivec2(inner.x, at.y))) / 3.0;
}`,
};

// What layouts of one kind of texels show in a direction; nothing where they show nothing.
const SAMPLE = `
vec4 sample_at(vec3 d)
{
    vec2 xy;
    int face;
    if (!pixel_of(xy, face, d))
        return vec4(0.0);
    ivec2 at = ivec2(floor(xy - 0.5));
    vec2 part = xy - 0.5 - vec2(at);
    return mix(mix(texel_at(face, at), texel_at(face, at + ivec2(1, 0)), part.x),
               mix(texel_at(face, at + ivec2(0, 1)), texel_at(face, at + 1), part.x), part.y);
}
`;

// A look into a panorama; after viewer/shaders/panorama.glsl.
export const panoramaShader = (projection) => `${HEAD}${FOOTPRINT}
uniform sampler2D view;
uniform vec2 elevation;  // cylinder: v_min, v_max
uniform vec3 look;       // pan and tilt in radians, 1 / zoom
uniform float planet;
uniform vec2 frame;
out vec4 colour;
const float PI = 3.14159265358979;
vec2 size;

vec3 look_ray(vec2 position)
{
    float a = (2.0 * position.x / frame.x - 1.0) * look.z;
    float b = (2.0 * position.y - frame.y) / frame.x * look.z;
    float depth = planet > 0.5 ? 0.5 * (1.0 - a * a - b * b) : 1.0;
    float up = b * cos(look.y) + depth * sin(look.y);
    float ahead = depth * cos(look.y) - b * sin(look.y);
    return vec3(a * cos(look.x) + ahead * sin(look.x), up, a * sin(look.x) - ahead * cos(look.x));
}
vec4 fetch(ivec2 at) { return texelFetch(view, at, 0); }
int wrap_index(int i, int n) { return i < 0 ? i + n : i >= n ? i - n : i; }
float azimuth_column(vec3 d) { return (atan(d.x, -d.z) + PI) / (2.0 * PI) * size.x; }
${LAYOUTS[projection]}
${projection === 'discs' ? '' : SAMPLE}
void main()
{
    size = vec2(textureSize(view, 0));
    vec2 at = gl_FragCoord.xy;
    vec3 ray = look_ray(at);
    Footprint across = footprint_of(texels_of(ray, look_ray(at + vec2(0.5, 0.0)) - look_ray(at - vec2(0.5, 0.0))));
    Footprint down = footprint_of(texels_of(ray, look_ray(at + vec2(0.0, 0.5)) - look_ray(at - vec2(0.0, 0.5))));
    vec4 sum = vec4(0.0);
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++)
            sum += sample_at(look_ray(at + vec2(footprint_place(across, i), -footprint_place(down, j))));
    colour = sum / float(across.count * down.count);
}`;

// ---------------------------------------------------------------- presenting

export const TONES = `
uniform int tone;
vec3 tone_apply(vec3 rgb)
{
    if (tone == 1) {
        float l = max(dot(rgb, LUMINANCE), 0.0);
        return clamp(rgb * ((1.0 + l / 16.0) / (1.0 + l)), 0.0, 1.0);
    }
    if (tone == 2) {
        vec3 x = clamp(rgb, 0.0, 65504.0);
        return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
    }
    if (tone == 3) {
        vec3 coded = pow(clamp(rgb, 0.0, 1.0), vec3(1.0 / 2.2));
        return mix(pow((coded + 0.055) / 1.055, vec3(2.4)), coded / 12.92, lessThanEqual(coded, vec3(0.04045)));
    }
    return clamp(rgb, 0.0, 1.0);
}
vec3 srgb(vec3 l)
{
    return mix(1.055 * pow(l, vec3(1.0 / 2.4)) - 0.055, 12.92 * l, lessThanEqual(l, vec3(0.0031308)));
}
`;

// Names of the passes, in the order of their numbers in the shader.
export const PASSES = ['colour', 'normals', 'specular', 'diffuse-gain', 'unsharp', 'luminance', 'false-colour'];
export const TONES_BY_NAME = ['linear', 'reinhard', 'filmic', 'gamma'];

// Exposure, pass, tone and the sRGB curve over the page's ground; after src/relight/normals/enhance.c and
// src/relight/eye/tone.c. Lights here are those that passes enhance: direction, colour.
// A shader for each pass: software renderers take long to make one of all.
export const presentShader = (pass) => `${HEAD}${LUMINANCE}
const int pass = ${pass};
uniform sampler2D light;
uniform sampler2D normals;
uniform sampler2D albedos;
uniform float exposure;
uniform vec3 ground;
uniform vec4 scale;       // low, high, pivot, scale of relume_pass_range
uniform int count;
uniform vec3 lamp[8];
uniform vec3 lampColour[8];
uniform vec3 lampSum;
uniform float radius;     // unsharp: pixels
out vec4 colour;
${TONES}
vec3 false_colour(float y)
{
    const vec3 steps[5] = vec3[5](vec3(0.0, 0.0, 0.1), vec3(0.15, 0.0, 0.35), vec3(0.65, 0.02, 0.1),
                                  vec3(0.95, 0.3, 0.0), vec3(1.0, 0.95, 0.3));
    float x = clamp(4.0 * (y - scale.x) / (scale.y - scale.x), 0.0, 4.0);
    int step_ = x < 3.0 ? int(x) : 3;
    return y > 1e-6 ? mix(steps[step_], steps[step_ + 1], x - float(step_)) : vec3(0.0);
}
vec3 specular(vec3 rgb, vec3 n)
{
    for (int i = 0; i < count; i++) {
        vec3 middle = lamp[i] + vec3(0.0, 0.0, 1.0);
        float cosine = dot(n, middle) / max(length(middle), 1e-6);
        rgb += scale.w * 0.6 * pow(max(cosine, 0.0), 40.0) * lampColour[i];
    }
    return rgb;
}
vec3 unsharp(ivec2 at, vec3 rgb, vec3 n, vec3 albedo)
{
    vec3 sum = vec3(0.0), change = vec3(0.0);
    for (int j = -4; j <= 4; j++)
        for (int i = -4; i <= 4; i++) {
            vec2 from = (vec2(at) + 0.5 + 0.25 * radius * vec2(i, j)) / vec2(textureSize(normals, 0));
            sum += texture(normals, from).xyz;
        }
    for (int i = 0; i < count; i++)
        change += 2.0 * dot(n - sum / 81.0, lamp[i]) * lampColour[i];
    return max(rgb + albedo * change, 0.0);
}
void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 shown = texelFetch(light, at, 0);
    float there = clamp(shown.a, 0.0, 1.0);
    vec3 rgb = there > 0.0 ? shown.rgb / shown.a : vec3(0.0);
    vec4 n = pass >= 1 && pass <= 4 ? texelFetch(normals, at, 0) : vec4(0.0);
    if (pass == 1) {
        vec3 code = n.a > 0.0 ? 0.5 * n.xyz / n.a + 0.5 : vec3(0.0);
        colour = vec4(mix(ground, code, there), 1.0);
        return;
    } else if (pass == 2) {
        rgb = n.a > 0.0 ? specular(rgb, n.xyz / n.a) : rgb;
    } else if (pass == 3) {
        vec3 most = scale.z * lampSum * texelFetch(albedos, at, 0).rgb;
        rgb = max(scale.w * (most + 2.0 * (rgb - most)), 0.0);
    } else if (pass == 4) {
        rgb = unsharp(at, rgb, n.xyz, texelFetch(albedos, at, 0).rgb);
    } else if (pass == 5) {
        rgb = vec3(dot(rgb, LUMINANCE));
    } else if (pass == 6) {
        rgb = false_colour(dot(rgb, LUMINANCE));
    }
    colour = vec4(mix(ground, srgb(tone_apply(exposure * rgb)), there), 1.0);
}`;
