#version 330 core
// What a light sample of an environment sends to a surface, and what of it arrives. Twin:
// share_of_sky of world/object/render.c.
#include "shared/cube.glsl"
#include "shadow.glsl"
uniform sampler2D place, normal_s;
uniform vec3 towards, rgb;
layout(location = 0) out vec4 sent;
layout(location = 1) out vec4 arrived;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 at = texelFetch(place, pixel, 0);
    vec3 normal = texelFetch(normal_s, pixel, 0).xyz;
    float cosine = dot(towards, normal);
    if (at.w == 0.0 || cosine <= 0.0)
        discard;
    sent = vec4(cosine * rgb, 1.0);
    arrived = reached(at.xyz, normal) * sent;
}
