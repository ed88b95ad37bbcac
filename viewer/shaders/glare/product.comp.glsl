#version 430
// Spectra of frame and kernel multiplied, colour by colour: red and green come apart since both are
// real. The kernel's place takes the product, two frequencies k and -k at a time.
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430, binding = 0) readonly buffer Frame { vec2 frame[]; };
layout(std430, binding = 1) buffer Kernel { vec2 kernel[]; };
uniform ivec2 size;

vec2 times(vec2 a, vec2 b)
{
    return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

vec2 first_of(vec2 here, vec2 there)
{
    return 0.5 * vec2(here.x + there.x, here.y - there.y);
}

vec2 second_of(vec2 here, vec2 there)
{
    return 0.5 * vec2(here.y + there.y, there.x - here.x);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, size)))
        return;
    ivec2 opposite = (size - at) % size;
    int i = at.y * size.x + at.x, j = opposite.y * size.x + opposite.x, n = size.x * size.y;
    if (j < i)
        return;
    vec2 red = times(first_of(frame[i], frame[j]), first_of(kernel[i], kernel[j]));
    vec2 green = times(second_of(frame[i], frame[j]), second_of(kernel[i], kernel[j]));
    vec2 blue = times(frame[n + i], kernel[n + i]);
    kernel[i] = vec2(red.x - green.y, red.y + green.x);
    kernel[j] = vec2(red.x + green.y, green.x - red.y);
    kernel[n + i] = blue;
    kernel[n + j] = vec2(blue.x, -blue.y);
}
