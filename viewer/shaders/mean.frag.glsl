#version 330 core
// A sum of weighted values over its weight; black and weightless where nothing was added.
uniform sampler2D sum;
uniform float exposure;
out vec4 color;

void main()
{
    vec4 total = texelFetch(sum, ivec2(gl_FragCoord.xy), 0);
    color = total.a > 0.0 ? vec4(exposure * total.rgb / total.a, 1.0) : vec4(0.0);
}
