#version 430
// The fine scales between two wavelengths, so that needles are lines and not beads.
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430, binding = 0) readonly buffer Pattern { float pattern[]; };
layout(std430, binding = 1) writeonly buffer Smeared { float smeared[]; };
uniform float fine[8];
uniform int fines;
#include "glare/plane.glsl"

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x > size || at.y > size)
        return;
    vec2 x = vec2(at - size / 2);
    float sum = 0.0;
    for (int j = 0; j < fines; j++) {
        bool inside = abs(x.x) <= floor(float(size / 2 - 1) / fine[j]);
        if (inside && plane_reaches(fine[j] * x))
            sum += fine[j] * fine[j] * plane_lookup(fine[j] * x);
    }
    smeared[at.y * (size + 1) + at.x] = sum / float(fines);
}
