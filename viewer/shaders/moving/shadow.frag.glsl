#version 330 core
// A light whose shadows move. Twin: add_row of src/relight/shadow/shadows.c.
#include "moving/shown.glsl"
#include "shared/moving.glsl"

uniform sampler2D colours;     // of the view; black: nothing is known
uniform sampler2D matte;       // a, b
uniform sampler2D arrives;     // quarters reached, bytes; of the rectangle and a pixel around it
uniform sampler2D reached0, reached1, reached2, reached3;  // the same of the view, by captured light
uniform vec3 towards;          // the light
uniform int around;            // captured lights
uniform vec4 captured[4];      // direction, weight
const float SHARE = 255.0 / 4.0;  // of quarters

float reached(int light, ivec2 at)
{
    return SHARE * (light == 0   ? soften(reached0, at)
                    : light == 1 ? soften(reached1, at)
                    : light == 2 ? soften(reached2, at)
                                 : soften(reached3, at));
}

void main()
{
    ivec2 here = ivec2(gl_FragCoord.xy), at = here + origin;
    vec3 colour = texelFetch(colours, at, 0).rgb, between = vec3(0.0);
    vec4 m = texelFetch(matte, at, 0);
    for (int i = 0; i < around; i++) {
        float known = reached(i, at) * shadows_matte(m, captured[i].xyz);
        between += captured[i].w * transfer_encode(display, colour * known);
    }
    float lit = SHARE * soften(arrives, here) * shadows_matte(m, towards);
    show(around > 0 ? colour * lit - transfer_decode(display, between) : vec3(0.0));
}
