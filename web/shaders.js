// shaders.js - what shaders of all pages share
//
// Formulas that the viewer has too are files of viewer/shaders/shared. Rows of textures run down
// the picture, those of frames up.
import LUMINANCE from '../viewer/shaders/shared/luminance.glsl';
import TONE from '../viewer/shaders/shared/tone.glsl';
import TRANSFER from '../viewer/shaders/shared/transfer.glsl';

export const HEAD = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
`;

// Linear light as a screen shows it.
export const SCREEN = `${LUMINANCE}${TRANSFER}${TONE}
uniform int tone;
vec3 shown(vec3 rgb) { return srgb_encode(tone_apply(tone, rgb, 4.0)); }
`;

// Names of the passes, in the order of their numbers in the shader.
export const PASSES = ['colour', 'normals', 'specular', 'diffuse-gain', 'unsharp', 'luminance', 'false-colour'];
export const TONES_BY_NAME = ['linear', 'reinhard', 'filmic', 'gamma'];
