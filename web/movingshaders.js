// movingshaders.js - shadows and highlights that move, on the graphics card
import GLOSS from '../viewer/shaders/shared/gloss.glsl';
import MOVING from '../viewer/shaders/shared/moving.glsl';
import NEAR_SHADOW from '../viewer/shaders/shared/near_shadow.glsl';
import STAGE from '../viewer/shaders/shared/stage.glsl';
import TRANSFER_ENCODE from '../viewer/shaders/shared/transfer_encode.glsl';
import { ARRIVING, TRIANGLES } from './near.js';
import { HEAD } from './shaders.js';
import { DECODE } from './tileshaders.js';

// A pixel of a reduced picture is so many of the view's wide.
const GRAIN = 'uniform float grain;\n';

const stageShader = (rays) => `
#define RAYS ${rays}
${STAGE}
vec2 stage_place(vec2 position) { return min(grain * position, vec2(textureSize(surface, 0)) - 0.01); }
`;

// What share of a pixel a distant light reaches, of a tile and a border of one pixel around it.
export const traceShader = (rays) => `${HEAD}${GRAIN}${stageShader(rays)}
uniform vec3 direction;
uniform vec2 origin, most;  // of the tile in its level; the size of that
out vec4 share;
void main()
{
    ivec2 size = ivec2(most), at = ivec2(gl_FragCoord.xy) + ivec2(origin) - 1;
    at.x = RAYS >= CYLINDER ? (at.x + size.x) % size.x : clamp(at.x, 0, size.x - 1);
    at.y = clamp(at.y, 0, size.y - 1);
    share = vec4(0.25 * float(quarters_reached(at, direction, BACKGROUND)));
}`;

// What is shown of one light: its relit tile and what the model adds, black where it would be less.
const RELIT = `${DECODE}${TRANSFER_ENCODE}${GRAIN}
uniform sampler2D relit;
uniform sampler2D colours;
uniform sampler2D matte;
uniform vec2 origin;
uniform float level;
out vec4 light;
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
export const shadowShader = () => `${HEAD}${RELIT}${SHOW}${MOVING}
uniform sampler2D arrives, reached0, reached1, reached2, reached3;
uniform vec4 captured0, captured1, captured2, captured3;  // direction, weight
void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 colour = model_at(colours).rgb;
    vec4 m = model_at(matte);
    ${[0, 1, 2, 3].map((i) => `vec3 v${i} = captured${i}.w * transfer_encode(display, colour * soften(reached${i}, at) * shadows_matte(m, captured${i}.xyz));`).join('\n    ')}
    show(colour * soften(arrives, at) * shadows_matte(m, towards) - transfer_decode(display, v0 + v1 + v2 + v3));
}`;

// A light whose highlights move.
export const glossShader = () => `${HEAD}${RELIT}${SHOW}${GLOSS}
uniform sampler2D lights;  // of each captured light: direction, weight
uniform int around;
void main()
{
    vec4 colour = model_at(colours), pixel = model_at(matte);
    show(pixel.w > 0.0 ? pixel.w * gloss_wanders(display, lights, around, colour, pixel, towards) : vec3(0.0));
}`;

// A near light whose shadows move, of one lamp or of 4 x 4 patches.
const MOST_PATCHES = 16;
export const nearShadowShader = (rays) => `${HEAD}${RELIT}${stageShader(rays)}${ARRIVING}${TRIANGLES}
uniform sampler2D lights;  // of each captured light: direction
uniform vec3 eye;
uniform vec3 lampAt[${MOST_PATCHES}], lampColour[${MOST_PATCHES}];
uniform int lamps;
${MOVING}${NEAR_SHADOW}
vec3 captured(vec3 towards, out float share)
{
    vec4 from = texture(taken, table_place(towards));
    share = from.a;
    return normalize(from.xyz);
}
vec3 turned_back(vec3 towards) { return towards; }
void main()
{
    at = ivec2(gl_FragCoord.xy + origin);
    model = model_at(matte);
    vec3 colour = model_at(colours).rgb, relit_ = texelFetch(relit, ivec2(gl_FragCoord.xy), 0).rgb, lit = vec3(0.0), between = vec3(0.0), point, towards;
    bool seen = colour != vec3(0.0) && stage_point(point, stage_place(vec2(at) + 0.5));
    for (int i = 0; i < lamps && seen; i++) {
        float sent;
        if (sends(towards, sent, lampAt[i], eye + point) && sent > 0.0)
            add_near(lit, between, sent * lampColour[i], colour, towards, distance(lampAt[i], eye + point), lamps == 1 ? -1 : i);
    }
    vec3 rest = relit_ - between;
    light = vec4(max((RAYS >= CYLINDER ? max(rest, 0.0) : rest) + lit, min(relit_, 0.0)), 1.0);
}`;
