#version 330 core
// The finished linear frame onto the screen: through a tone operator, coded as sRGB, first row at
// the top.
#include "transfer.glsl"
#include "shared/luminance.glsl"
#include "shared/tone.glsl"
uniform sampler2D frame;
uniform int tone;  // place in relume_tones
uniform float white;
uniform vec2 frame_size;
uniform float left;  // of the frame in the window
out vec4 color;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.x - left, frame_size.y - gl_FragCoord.y);
    vec3 linear = tone_apply(tone, texelFetch(frame, at, 0).rgb, white);
    color = vec4(srgb_encode(linear), 1.0);
}
