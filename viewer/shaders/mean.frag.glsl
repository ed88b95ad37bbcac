#version 330 core
// A sum of weighted values over its weight; black where nothing was added.
uniform sampler2D sum;
uniform float exposure;
out vec4 color;

void main()
{
    vec4 total = texelFetch(sum, ivec2(gl_FragCoord.xy), 0);
    color = vec4(total.a > 0.0 ? exposure * total.rgb / total.a : vec3(0.0), total.a > 0.0 ? 1.0 : 0.0);
}
