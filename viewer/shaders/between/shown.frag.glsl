#version 330 core
// What the frame shows under a light, for methods that go by it. Twins: exchange_dimmed and
// src/world/object/exchange.c.
uniform sampler2D front;                   // places; 2: objects
uniform sampler2D objects, shaded;         // `grid` times finer
uniform sampler2D lone;                    // the scene
uniform sampler2D let_without, let_with;   // lamps.frag
uniform sampler2D mean;                    // one texel
uniform sampler2D emitted;                 // what objects send of their own
uniform float sends;                       // the part of it that counts
uniform int grid;
out vec4 color;

float sum_of(vec3 rgb)
{
    return rgb.r + rgb.g + rgb.b;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (texelFetch(front, pixel, 0).w == 2.0) {
        vec4 sum = vec4(0.0);
        for (int i = 0; i < grid * grid; i++) {
            ivec2 at = pixel * grid + ivec2(i % grid, i / grid);
            if (texelFetch(objects, at, 0).w != 0.0)
                sum += vec4(texelFetch(shaded, at, 0).rgb +
                            (sends > 0.0 ? sends * texelFetch(emitted, at, 0).rgb : vec3(0.0)), 1.0);
        }
        color = vec4(sum.rgb / max(sum.a, 1.0), 1.0);
        return;
    }
    float rest = sum_of(texelFetch(mean, ivec2(0), 0).rgb);
    float before = rest + sum_of(texelFetch(let_without, pixel, 0).rgb);
    float after = rest + sum_of(texelFetch(let_with, pixel, 0).rgb);
    color = vec4((before > 0.0 ? after / before : 1.0) * texelFetch(lone, pixel, 0).rgb, 1.0);
}
