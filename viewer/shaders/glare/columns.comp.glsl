#version 430
// The pattern at the frame's scale: columns of pixels from columns of texels.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Rows { vec4 row[]; };
layout(std430, binding = 1) writeonly buffer Pixels { vec4 pixel[]; };  // [2 reach + 1]^2
#include "glare/share.glsl"

void main()
{
    int x = int(gl_GlobalInvocationID.x), y = int(gl_WorkGroupID.y), side = 2 * reach + 1;
    if (x >= side)
        return;
    ivec2 texels = share_texels(x - reach);
    vec4 sum = vec4(0.0);
    for (int k = texels.x; k <= texels.y; k++)
        sum += share_of(x - reach, k) * row[y * field + k + field / 2];
    pixel[y * side + x] = sum;
}
