#version 330 core
// A source smaller than a pixel, shared among the four pixels about its place.
uniform vec2 middle;  // pixels of the frame
uniform vec3 value;   // the sum over the four
out vec4 color;

void main()
{
    vec2 share = max(1.0 - abs(gl_FragCoord.xy - middle), 0.0);
    color = vec4(value * share.x * share.y, 0.0);
}
