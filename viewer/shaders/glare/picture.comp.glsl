#version 430
// What is seen, out of its two planes.
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430, binding = 0) readonly buffer Planes { vec2 number[]; };
layout(rgba32f, binding = 0) writeonly uniform image2D seen;
uniform ivec2 size;  // of a plane
uniform float factor;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(seen))))
        return;
    int i = at.y * size.x + at.x;
    imageStore(seen, at, vec4(factor * vec3(number[i], number[size.x * size.y + i].x), 1.0));
}
