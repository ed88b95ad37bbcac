#version 330 core
// One light of a display-domain file: code values become linear light before lights are added.
#include "transfer.glsl"
#include "shared/luminance.glsl"
#include "above_zero.glsl"
uniform sampler2D coded;
uniform Transfer display;
uniform vec3 light;  // linear value
uniform bool guard;  // environments are among what was summed
out vec4 color;

void main()
{
    vec3 linear = transfer_decode(display, texelFetch(coded, ivec2(gl_FragCoord.xy), 0).rgb);
    color = vec4(light * (guard ? above_zero(linear) : linear), 1.0);
}
