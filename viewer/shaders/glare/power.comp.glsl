#version 430
// The wave's transform becomes its power at 575 nm, angle 0 in the middle, coefficient k at -k as the
// eye sees it from inside. Column and row `size` repeat the first. `texel`: what the average over a
// texel took from each frequency.
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430, binding = 0) readonly buffer Wave { vec2 wave[]; };
layout(std430, binding = 1) readonly buffer Texel { float texel[]; };
layout(std430, binding = 2) writeonly buffer Power { float power[]; };
uniform int size;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x > size || at.y > size)
        return;
    ivec2 k = (size / 2 - at + 2 * size) % size;
    vec2 z = wave[k.y * size + k.x];
    power[at.y * (size + 1) + at.x] = dot(z, z) * texel[k.x] * texel[k.y];
}
