#version 430
// What must be known of a frame before it is seen: its luminance, its greatest number, whether it is
// as it was. One result for each work group; `before` becomes the frame.
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430, binding = 0) writeonly buffer Results { vec4 result[]; };  // sum, greatest, changed
layout(rgba32f, binding = 0) uniform image2D before;
uniform sampler2D frame;

shared vec3 part[256];

bool is_number(float x)
{
    return !isnan(x) && !isinf(x);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    int me = int(gl_LocalInvocationIndex);
    part[me] = vec3(0.0);
    if (all(lessThan(at, textureSize(frame, 0)))) {
        vec4 now = vec4(texelFetch(frame, at, 0).rgb, 1.0);
        float light = dot(now.rgb, vec3(0.2126, 0.7152, 0.0722));
        part[me].x = is_number(light) ? max(light, 0.0) : 0.0;
        for (int c = 0; c < 3; c++)
            part[me].y = max(part[me].y, is_number(now[c]) ? now[c] : 0.0);
        bool same = floatBitsToUint(imageLoad(before, at)) == floatBitsToUint(now);
        part[me].z = same ? 0.0 : 1.0;
        imageStore(before, at, now);
    }
    barrier();
    for (int n = 128; n > 0; n /= 2) {
        if (me < n)
            part[me] = vec3(part[me].x + part[me + n].x, max(part[me].yz, part[me + n].yz));
        barrier();
    }
    if (me == 0)
        result[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = vec4(part[0], 0.0);
}
