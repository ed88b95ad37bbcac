#version 330 core
// How far two frames of one size are from each other.
uniform sampler2D frame, other;
out vec4 color;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    color = vec4(abs(texelFetch(frame, at, 0).rgb - texelFetch(other, at, 0).rgb), 1.0);
}
