// tileshaders.js - tiles under lights, their normals, and the frame on the screen
import ENHANCE from '../viewer/shaders/shared/enhance.glsl';
import LUMINANCE from '../viewer/shaders/shared/luminance.glsl';
import TRANSFER from '../viewer/shaders/shared/transfer.glsl';
import { HEAD, SCREEN } from './shaders.js';

// Codes to linear light, by the curve of the file.
export const DECODE = `${TRANSFER}uniform Transfer display;
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
    ${Array.from({ length: count }, (_, i) => `sum += weight[${i * stride + 3 * layers + 1}].rgb * transfer_decode(display, ${value(i * stride)});`).join('\n    ')}
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
        sampled[i] = luminance(transfer_decode(display, value(i)));
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
        sum += share[i] * cosine * transfer_decode(display, value(i));
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

// Exposure, pass, tone and the sRGB curve over the page's ground. Lights here are those that passes
// enhance: direction, colour. A shader for each pass: software renderers take long to make one of all.
export const presentShader = (pass) => `${HEAD}${SCREEN}${ENHANCE}
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
vec3 specular(vec3 rgb, vec3 n)
{
    for (int i = 0; i < count; i++)
        rgb += scale.w * 0.6 * specular_lobe(n, lamp[i] + vec3(0.0, 0.0, 1.0), 40.0) * lampColour[i];
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
    vec4 lit = texelFetch(light, at, 0);
    float there = clamp(lit.a, 0.0, 1.0);
    vec3 rgb = there > 0.0 ? lit.rgb / lit.a : vec3(0.0);
    vec4 n = pass >= 1 && pass <= 4 ? texelFetch(normals, at, 0) : vec4(0.0);
    if (pass == 1) {
        vec3 code = n.a > 0.0 ? 0.5 * n.xyz / n.a + 0.5 : vec3(0.0);
        colour = vec4(mix(ground, code, there), 1.0);
        return;
    } else if (pass == 2) {
        rgb = n.a > 0.0 ? specular(rgb, n.xyz / n.a) : rgb;
    } else if (pass == 3) {
        rgb = diffuse_gain(rgb, scale.z * lampSum * texelFetch(albedos, at, 0).rgb, 2.0, scale.w);
    } else if (pass == 4) {
        rgb = unsharp(at, rgb, n.xyz, texelFetch(albedos, at, 0).rgb);
    } else if (pass == 5) {
        rgb = vec3(luminance(rgb));
    } else if (pass == 6) {
        rgb = false_colour(rgb, scale.xy);
    }
    colour = vec4(mix(ground, shown(exposure * rgb), there), 1.0);
}`;
