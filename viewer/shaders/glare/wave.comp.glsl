#version 430
// The aperture becomes the wave behind it: transmittance times the phase E of a residual defocus
// (Ritschel 2009, Eq. 8.3), which is the same along both axes. An aperture wider than the transform is
// folded: tiles of it are added up, which samples the same pattern more sparsely.
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430, binding = 0) writeonly buffer Wave { vec2 wave[]; };
layout(std430, binding = 1) readonly buffer Phase { vec2 phase[]; };
uniform sampler2D aperture;
uniform int size, tiles;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= size || at.y >= size)
        return;
    vec2 sum = vec2(0.0);
    for (int j = at.y; j < tiles * size; j += size)
        for (int i = at.x; i < tiles * size; i += size) {
            vec2 x = phase[i], y = phase[j];
            float t = texelFetch(aperture, ivec2(i, j), 0).r;
            sum += t * vec2(x.x * y.x - x.y * y.y, x.x * y.y + x.y * y.x);
        }
    wave[at.y * size + at.x] = sum;
}
