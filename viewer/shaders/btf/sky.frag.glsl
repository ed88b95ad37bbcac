#version 330 core
// What an environment shows of a surface, times the share that arrives. Twin: add_sky.
uniform sampler2D shown, sent, arrived;
out vec4 color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 all = texelFetch(sent, pixel, 0).rgb, part = texelFetch(arrived, pixel, 0).rgb;
    vec3 share = mix(vec3(1.0), part / max(all, 1e-30), greaterThan(all, vec3(0.0)));
    color = vec4(share * texelFetch(shown, pixel, 0).rgb, 1.0);
}
