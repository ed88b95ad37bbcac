#version 330 core
// A mean over the pixels that share a pattern of directions, of those that are the same surface.
// Twin: world/transport/smooth.c.
uniform sampler2D first, second;  // what was gathered; alpha 0: nothing
uniform sampler2D place, facing;
uniform vec3 eye;
uniform int size;
layout(location = 0) out vec4 first_mean;
layout(location = 1) out vec4 second_mean;

const float FACING = 0.9, PLANE = 0.02;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 at = texelFetch(place, pixel, 0).xyz, normal = texelFetch(facing, pixel, 0).xyz;
    float away = distance(at, eye);
    first_mean = second_mean = vec4(0.0);
    if (texelFetch(first, pixel, 0).a == 0.0)
        discard;
    for (int i = 0; i < size * size; i++) {
        ivec2 beside = pixel - size / 2 + ivec2(i % size, i / size);
        if (any(lessThan(beside, ivec2(0))) || any(greaterThanEqual(beside, textureSize(first, 0))))
            continue;
        vec4 value = texelFetch(first, beside, 0);
        if (value.a == 0.0 || dot(normal, texelFetch(facing, beside, 0).xyz) <= FACING ||
            abs(dot(texelFetch(place, beside, 0).xyz - at, normal)) >= PLANE * away)
            continue;
        first_mean += value;
        second_mean += texelFetch(second, beside, 0);
    }
    first_mean /= max(first_mean.a, 1.0);
    second_mean /= max(second_mean.a, 1.0);
}
