#version 330 core
// A light whose highlights move.
#include "moving/shown.glsl"
#include "shared/gloss.glsl"

uniform sampler2D colours;  // of the view; x of the normal
uniform sampler2D matte;    // y of the normal, roughness, shine, share
uniform vec3 towards;       // the light
uniform int around;         // captured lights
uniform sampler2D lights;   // of each: direction, weight

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy) + origin;
    vec4 colour = texelFetch(colours, at, 0), pixel = texelFetch(matte, at, 0);
    show(pixel.w > 0.0 ? pixel.w * gloss_wanders(display, lights, around, colour, pixel, towards)
                       : vec3(0.0));
}
