#version 430
// The pattern at the frame's scale: rows of pixels from rows of texels.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Colours { vec4 colour[]; };
layout(std430, binding = 1) writeonly buffer Rows { vec4 row[]; };  // [2 reach + 1][field]
#include "glare/share.glsl"

void main()
{
    int x = int(gl_GlobalInvocationID.x), y = int(gl_WorkGroupID.y);
    if (x >= field)
        return;
    ivec2 texels = share_texels(y - reach);
    vec4 sum = vec4(0.0);
    for (int k = texels.x; k <= texels.y; k++)
        sum += share_of(y - reach, k) * colour[(k + field / 2) * field + x];
    row[y * field + x] = sum;
}
