#version 330 core
// A light whose highlights move. Twins: gloss_shown and gloss_wanders of src/relight/shadow/gloss.c.
#include "moving/shown.glsl"

uniform sampler2D colours;  // of the view; x of the normal
uniform sampler2D matte;    // y of the normal, roughness, shine, share
uniform vec3 towards;       // the light
uniform int around;         // captured lights
uniform sampler2D lights;   // of each: direction, weight
const float LEAST_ROUGHNESS = 0.05;

vec3 gloss_shown(vec4 colour, vec4 pixel, vec3 light)
{
    vec2 xy = vec2(colour.w, pixel.x);
    float z = sqrt(max(1.0 - dot(xy, xy), 1e-6)), cosine = dot(vec3(xy, z), light);
    if (!(cosine > 0.0))
        return vec3(0.0);
    float towards_half = max((cosine + z) / sqrt(max(2.0 + 2.0 * light.z, 1e-6)), 0.0);
    float r = max(pixel.y, LEAST_ROUGHNESS), a2 = r * r * r * r;
    float d = towards_half * towards_half * (a2 - 1.0) + 1.0;
    float lobe = a2 * cosine / (d * d * (cosine + sqrt(a2 + (1.0 - a2) * cosine * cosine)) *
                                (z + sqrt(a2 + (1.0 - a2) * z * z)));
    return min(pixel.z < 0.0 ? colour.rgb * lobe : colour.rgb * cosine + pixel.z * lobe, 1.0);
}

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy) + origin;
    vec4 colour = texelFetch(colours, at, 0), pixel = texelFetch(matte, at, 0);
    vec3 between = vec3(0.0);
    for (int i = 0; i < around && pixel.w > 0.0; i++) {
        vec4 light = texelFetch(lights, ivec2(i, 0), 0);
        between += light.w * encoded(gloss_shown(colour, pixel, light.xyz));
    }
    show(pixel.w > 0.0
             ? pixel.w * (gloss_shown(colour, pixel, towards) - decoded(display, between))
             : vec3(0.0));
}
