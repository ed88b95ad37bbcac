#version 430
// The frame, black around it, as complex numbers in two planes: red + i green, and blue. What is no
// number counts as black, what is infinite as the brightest finite number.
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430, binding = 0) writeonly buffer Planes { vec2 number[]; };
uniform sampler2D frame;
uniform ivec2 size;      // of a plane
uniform float greatest;

float clean(float x)
{
    return isnan(x) || (isinf(x) && x < 0.0) ? 0.0 : isinf(x) ? greatest : x;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, size)))
        return;
    bool inside = all(lessThan(at, textureSize(frame, 0)));
    vec3 rgb = inside ? texelFetch(frame, at, 0).rgb : vec3(0.0);
    int i = at.y * size.x + at.x;
    number[i] = vec2(clean(rgb.r), clean(rgb.g));
    number[size.x * size.y + i] = vec2(clean(rgb.b), 0.0);
}
