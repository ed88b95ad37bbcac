// objectshaders.js - a baked object on the graphics card
import BAKED from '../viewer/shaders/shared/baked.glsl';
import { HEAD, SCREEN } from './shaders.js';

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

// Arrays are textures here: WebGL 2 has no texture buffers, by which the viewer reads them.
export const objectShader = (views) => `${HEAD}
precision highp usampler2D;
uniform usampler2D clusters;
uniform sampler2DArray weights;  // four components a layer
uniform sampler2DArray frames;   // normals, tangents
uniform sampler2D colours;
uniform int components;
uniform vec3 eye;
in vec3 where;
in vec2 place;
out vec4 colour;
const int ACROSS = ${COLOURS_ACROSS};
${views ? 'uniform int side' : 'const int side = 1'};
int first;  // of the vectors of the texel that was found
${BAKED}
bool find_texel(ivec2 texel)
{
    uint cluster = texelFetch(clusters, texel, 0).r;
    first = int(cluster) * (1 + components) * side * side;
    return cluster != 65535u;
}
void texel_frame(out vec3 normal, out vec3 tangent, ivec2 texel)
{
    normal = normalize(texelFetch(frames, ivec3(texel, 0), 0).xyz);
    tangent = normalize(texelFetch(frames, ivec3(texel, 1), 0).xyz);
}
vec3 colour_of(int vector)
{
    return texelFetch(colours, ivec2(vector % ACROSS, vector / ACROSS), 0).rgb;
}
vec3 show_view(ivec2 texel, int view)
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
void main()
{
    colour = vec4(baked_value(place, textureSize(clusters, 0), normalize(eye - where)), 1.0);
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
export const objectPresentShader = () => `${HEAD}${SCREEN}
uniform sampler2D light;
uniform float exposure;
in vec2 place;
out vec4 colour;
void main()
{
    vec3 rgb = texture(light, vec2(place.x, 1.0 - place.y)).rgb;
    colour = vec4(shown(exposure * rgb), 1.0);
}`;
