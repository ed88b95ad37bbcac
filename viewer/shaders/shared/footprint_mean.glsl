// The mean of value_at, which the shader defines, over what a pixel of the frame covers: `texels`
// along each side. Positions count from the pixel's middle. After footprint.
vec4 value_at(vec2 within);

vec4 footprint_mean(vec2 texels)
{
    Footprint across = footprint_of(texels.x);
    Footprint down = footprint_of(texels.y);
    vec4 sum = vec4(0.0);
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++)
            sum += value_at(vec2(footprint_place(across, i), footprint_place(down, j)));
    return sum / float(across.count * down.count);
}
