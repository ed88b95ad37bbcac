// objectshaders.js - a baked object on the graphics card; twin of src/world/baked/lit.c
import { HEAD, LUMINANCE, TONES } from './shaders.js';

export const COLOURS_ACROSS = 1024;  // of the texture of colours

// Positions and places are shares of 65535, of the object's box and of its atlas. The window is as
// relume_objects_window has it, its middle moved and enlarged.
export const OBJECT_VERTEX = `${HEAD}
layout(location = 0) in vec4 position;
layout(location = 1) in vec2 at;
uniform vec3 low, high, eye, right, down, ahead;
uniform vec4 window;  // half of it at distance 1: across, down; its middle, in these
uniform vec2 depths;  // nearest and farthest
out vec3 where;
out vec2 place;
void main()
{
    where = mix(low, high, position.xyz);
    place = at;
    vec3 to = where - eye;
    float z = dot(to, ahead);
    float depth = (z * (depths.y + depths.x) - 2.0 * depths.x * depths.y) / (depths.y - depths.x);
    gl_Position = vec4(dot(to, right) / window.x - window.z * z, window.w * z - dot(to, down) / window.y, depth, z);
}`;

export const objectShader = (views) => `${HEAD}
precision highp usampler2D;
uniform usampler2D clusters;
uniform sampler2DArray weights;  // four components a layer
uniform sampler2DArray frames;   // normals, tangents
uniform sampler2D colours;
uniform int side, components;
uniform vec3 eye;
in vec3 where;
in vec2 place;
out vec4 colour;
const int ACROSS = ${COLOURS_ACROSS};
vec3 colour_of(int vector)
{
    return texelFetch(colours, ivec2(vector % ACROSS, vector / ACROSS), 0).rgb;
}
// A texel in one view of the map.
vec3 add_view(ivec2 texel, int first, int view)
{
    vec3 sum = colour_of(first + view);
    vec4 four = vec4(0.0);
    for (int i = 0; i < components; i++) {
        if (i % 4 == 0)
            four = texelFetch(weights, ivec3(texel, i / 4), 0);
        sum += four[i % 4] * colour_of(first + (i + 1) * side * side + view);
    }
    return sum;
}
${views ? `
vec2 view_place(vec3 v)
{
    const float LOWEST = 1e-3;
    float across = length(v.xy), z = max(v.z, LOWEST);
    vec2 flat_ = v.z < LOWEST && across > 0.0 ? v.xy / across : v.xy;
    return (clamp(flat_ / (1.0 + z), -1.0, 1.0) + 1.0) * 0.5 * float(side - 1);
}
vec3 add_texel(ivec2 texel, int first, vec3 to)
{
    vec3 normal = texelFetch(frames, ivec3(texel, 0), 0).xyz, tangent = texelFetch(frames, ivec3(texel, 1), 0).xyz;
    normal = normalize(normal);
    tangent = normalize(tangent);
    vec2 at = view_place(vec3(dot(to, tangent), dot(to, cross(normal, tangent)), dot(to, normal)));
    ivec2 corner = min(ivec2(floor(at)), side - 2);
    vec2 f = at - vec2(corner);
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 4; k++) {
        ivec2 step_ = ivec2(k % 2, k / 2);
        float share = (k % 2 == 1 ? f.x : 1.0 - f.x) * (k / 2 == 1 ? f.y : 1.0 - f.y);
        if (share > 0.0)
            sum += share * add_view(texel, first, (corner.y + step_.y) * side + corner.x + step_.x);
    }
    return sum;
}` : `
vec3 add_texel(ivec2 texel, int first, vec3 to)
{
    return add_view(texel, first, 0);
}`}
// The four texels around the place, those of them that hold something.
void main()
{
    ivec2 size = textureSize(clusters, 0);
    vec2 at = clamp(place * vec2(size) - 0.5, vec2(0.0), vec2(size - 1));
    ivec2 corner = ivec2(floor(at));
    vec2 f = at - vec2(corner);
    vec3 sum = vec3(0.0), to = normalize(eye - where);
    float all = 0.0;
    for (int k = 0; k < 4; k++) {
        float share = (k % 2 == 1 ? f.x : 1.0 - f.x) * (k / 2 == 1 ? f.y : 1.0 - f.y);
        ivec2 texel = min(corner + ivec2(k % 2, k / 2), size - 1);
        uint cluster = texelFetch(clusters, texel, 0).r;
        if (!(share > 0.0) || cluster == 65535u)
            continue;
        sum += share * add_texel(texel, int(cluster) * (1 + components) * side * side, to);
        all += share;
    }
    colour = vec4(all > 0.0 ? max(sum / all, 0.0) : vec3(0.0), 1.0);
}`;

// The distance of a place along the look.
export const distanceShader = () => `${HEAD}
uniform vec3 eye, ahead;
uniform float unit;
in vec3 where;
out vec4 colour;
void main()
{
    colour = vec4(unit * dot(where - eye, ahead));
}`;

// Exposure, tone and the sRGB curve before black, as 'relume btf render' shows it.
export const objectPresentShader = () => `${HEAD}${LUMINANCE}
uniform sampler2D light;
uniform float exposure;
in vec2 place;
out vec4 colour;
${TONES}
void main()
{
    vec3 rgb = texture(light, vec2(place.x, 1.0 - place.y)).rgb;
    colour = vec4(srgb(tone_apply(exposure * rgb)), 1.0);
}`;
