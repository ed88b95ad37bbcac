#version 330 core
// The finished linear frame onto the screen: coded as sRGB, first row at the top.
#include "transfer.glsl"
uniform sampler2D frame;
uniform vec2 frame_size;
out vec4 color;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.x, frame_size.y - gl_FragCoord.y);
    vec3 linear = clamp(texelFetch(frame, at, 0).rgb, 0.0, 1.0);
    Transfer srgb = Transfer(CURVE_SRGB, 1.0);
    color = vec4(transfer_encode(srgb, linear.r), transfer_encode(srgb, linear.g),
                 transfer_encode(srgb, linear.b), 1.0);
}
