#version 330 core
// One light of a display-domain file: code values become linear light before lights are added.
#include "transfer.glsl"
uniform sampler2D coded;
uniform Transfer display;
uniform vec3 light;  // linear value
uniform bool guard;  // environments are among what was summed
out vec4 color;

// Twin: keep_above_zero (relight.c).
vec3 above_zero(vec3 rgb)
{
    float least = min(rgb.r, min(rgb.g, rgb.b)), grey = dot(rgb, vec3(0.2126, 0.7152, 0.0722));
    if (least >= 0.0)
        return rgb;
    return grey > 0.0 ? max(grey * (rgb - least) / (grey - least), 0.0) : vec3(0.0);
}

void main()
{
    vec3 code = texelFetch(coded, ivec2(gl_FragCoord.xy), 0).rgb;
    vec3 linear = vec3(transfer_decode(display, code.r), transfer_decode(display, code.g),
                       transfer_decode(display, code.b));
    color = vec4(light * (guard ? above_zero(linear) : linear), 1.0);
}
