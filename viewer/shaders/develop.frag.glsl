#version 330 core
// One light of a display-domain file: code values become linear light before lights are added.
#include "transfer.glsl"
#include "above_zero.glsl"
uniform sampler2D coded;
uniform Transfer display;
uniform vec3 light;  // linear value
uniform bool guard;  // environments are among what was summed
out vec4 color;

void main()
{
    vec3 code = texelFetch(coded, ivec2(gl_FragCoord.xy), 0).rgb;
    vec3 linear = vec3(transfer_decode(display, code.r), transfer_decode(display, code.g),
                       transfer_decode(display, code.b));
    color = vec4(light * (guard ? above_zero(linear) : linear), 1.0);
}
