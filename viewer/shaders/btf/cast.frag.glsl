#version 330 core
// What one light sample alone shows of a scene, where no object keeps it off. Twin:
// src/world/object/scene.c.
#include "shared/cube.glsl"
#include "shadow.glsl"
#include "between/scene_normal.glsl"
uniform sampler2D lone;
uniform vec4 light_samples[64];  // of the light: direction times value, 0; or place, value
uniform int count, light_sample;  // 0: the light is one sample
out vec4 color;

// Twin: counts_for.
float counts_for(vec4 by, vec3 point, vec3 normal)
{
    bool near = by.w > 0.0;
    float value = near ? by.w : length(by.xyz);
    vec3 towards = near ? normalize(by.xyz - point) : by.xyz / max(value, 1e-30);
    return value * (normal == vec3(0.0) ? 1.0 : max(dot(normal, towards), 0.0));
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 point = texelFetch(scene, pixel, 0);
    float weight = count > 0 ? 1.0 / float(count) : 1.0, sent = weight;
    if (count > 0 && point.a > 0.0) {
        vec3 normal = scene_normal(pixel);
        sent = 0.0;
        for (int i = 0; i < count; i++)
            sent += counts_for(light_samples[i], point.xyz, normal);
        weight = sent > 0.0 ? counts_for(light_samples[light_sample], point.xyz, normal) / sent
                            : weight;
    }
    float seen = point.a > 0.0 && sent > 0.0 ? reached(point.xyz, vec3(0.0)) : 1.0;
    color = vec4(weight * seen * texelFetch(lone, pixel, 0).rgb, 1.0);
}
