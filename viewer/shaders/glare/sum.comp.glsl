#version 430
// Sums of lines, each added by one work group.
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Numbers { vec4 number[]; };
layout(std430, binding = 1) writeonly buffer Sums { vec4 sum[]; };
uniform int count;  // of a line

shared vec4 part[64];

void main()
{
    int line = int(gl_WorkGroupID.x), me = int(gl_LocalInvocationID.x);
    vec4 mine = vec4(0.0);
    for (int i = me; i < count; i += 64)
        mine += number[line * count + i];
    part[me] = mine;
    barrier();
    for (int n = 32; n > 0; n /= 2) {
        if (me < n)
            part[me] += part[me + n];
        barrier();
    }
    if (me == 0)
        sum[line] = part[0];
}
