#version 430
// The sum over wavelengths: scaled copies of the pattern at 575 nm (Ritschel 2009, 8.4.3).
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430, binding = 0) readonly buffer Pattern { float pattern[]; };
layout(std430, binding = 1) readonly buffer Taps { vec4 tap[]; };  // scale, linear RGB
layout(std430, binding = 2) writeonly buffer Colours { vec4 colour[]; };
uniform int taps;
uniform int field;         // texels of the result, odd
uniform vec2 fade_radius;  // texels: it fades out from the first to the second
#include "glare/plane.glsl"

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= field || at.y >= field)
        return;
    vec2 x = vec2(at - field / 2);
    float away = length(x);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < taps && away <= fade_radius.y; i++) {
        bool inside = abs(x.x) <= floor(float(size / 2 - 1) / tap[i].x);
        if (inside && plane_reaches(tap[i].x * x))
            sum += tap[i].yzw * plane_lookup(tap[i].x * x);
    }
    float t = clamp((away - fade_radius.x) / (fade_radius.y - fade_radius.x), 0.0, 1.0);
    colour[at.y * field + at.x] = vec4(sum * (1.0 - t * t * (3.0 - 2.0 * t)), 0.0);
}
