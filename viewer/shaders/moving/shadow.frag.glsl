#version 330 core
// A light whose shadows move. Twins: add_pixel and soften of src/relight/shadow/shadows.c.
#include "moving/shown.glsl"

uniform sampler2D colours;     // of the view; black: nothing is known
uniform sampler2D matte;       // a, b
uniform sampler2D arrives;     // of the rectangle and a border of one pixel: quarters reached
uniform sampler2D reached0, reached1, reached2, reached3;  // the same of the view, by captured light
uniform vec3 towards;          // the light
uniform int around;            // captured lights
uniform vec4 captured[4];      // direction, weight

// Edges are known to a pixel, and as soft as that.
float soft(sampler2D quarters, ivec2 at)
{
    float sum = 5.0 * texelFetch(quarters, at + 1, 0).r;
    sum += texelFetch(quarters, at + ivec2(1, 0), 0).r + texelFetch(quarters, at + ivec2(0, 1), 0).r;
    sum += texelFetch(quarters, at + ivec2(2, 1), 0).r + texelFetch(quarters, at + ivec2(1, 2), 0).r;
    return sum * (255.0 / 36.0);
}

float reached(int light, ivec2 at)
{
    return light == 0   ? soft(reached0, at)
           : light == 1 ? soft(reached1, at)
           : light == 2 ? soft(reached2, at)
                        : soft(reached3, at);
}

void main()
{
    ivec2 here = ivec2(gl_FragCoord.xy), at = here + origin;
    vec3 colour = texelFetch(colours, at, 0).rgb, between = vec3(0.0);
    vec4 m = texelFetch(matte, at, 0);
    for (int i = 0; i < around; i++) {
        float known = reached(i, at) * max(m.x + dot(m.yzw, captured[i].xyz), 0.0);
        between += captured[i].w * encoded(colour * known);
    }
    float lit = soft(arrives, here) * max(m.x + dot(m.yzw, towards), 0.0);
    show(around > 0 ? colour * lit - decoded(display, between) : vec3(0.0));
}
