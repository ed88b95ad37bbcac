#version 330 core
// The scene as it is with the objects: what it shows alone times what arrives with them over what
// arrives without. Twin: exchange_quotient.
uniform sampler2D scene, lone;
uniform sampler2D let_without, let_with, all_without, all_with;  // lamps.frag
uniform sampler2D without, with_objects;                         // gathered
uniform float exposure;
out vec4 color;

float sum_of(vec3 rgb)
{
    return rgb.r + rgb.g + rgb.b;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 shown = texelFetch(lone, pixel, 0).rgb;
    color = vec4(exposure * shown, 1.0);
    if (texelFetch(scene, pixel, 0).a == 0.0 || texelFetch(without, pixel, 0).a == 0.0)
        return;
    vec3 bare = texelFetch(without, pixel, 0).rgb, full = texelFetch(with_objects, pixel, 0).rgb;
    vec3 lamps = texelFetch(let_without, pixel, 0).rgb, left = texelFetch(let_with, pixel, 0).rgb;
    float arrives = sum_of(lamps) + sum_of(bare);
    float hidden = smoothstep(1.0, 1.5, arrives > 0.0 ? sum_of(shown) / arrives : 1e30);
    vec3 before = bare + mix(lamps, texelFetch(all_without, pixel, 0).rgb, hidden);
    vec3 after = full + mix(left, texelFetch(all_with, pixel, 0).rgb, hidden);
    vec3 unknown = max(shown - before, 0.0);
    vec3 part = vec3(1.0);
    for (int c = 0; c < 3; c++)
        if (before[c] + unknown[c] > 0.0)
            part[c] = (after[c] + unknown[c]) / (before[c] + unknown[c]);
    color = vec4(exposure * shown * part, 1.0);
}
