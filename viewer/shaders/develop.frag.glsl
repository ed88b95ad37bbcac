#version 330 core
// One light of a display-domain file: code values become linear light before lights are added.
#include "transfer.glsl"
uniform sampler2D coded;
uniform Transfer display;
uniform vec3 light;  // linear value
out vec4 color;

void main()
{
    vec3 code = texelFetch(coded, ivec2(gl_FragCoord.xy), 0).rgb;
    vec3 linear = vec3(transfer_decode(display, code.r), transfer_decode(display, code.g),
                       transfer_decode(display, code.b));
    color = vec4(light * linear, 1.0);
}
