// A sphere. After panorama_layout.
bool panorama_pixel(out vec2 xy, out int face, vec3 d)
{
    face = 0;
    float down = 0.5 - atan(d.y, length(d.xz)) / PI;
    xy = vec2(azimuth_column(d), down * float(textureSize(view, 0).y));
    return true;
}

float panorama_texels(vec3 d, vec3 move)
{
    vec2 size = vec2(textureSize(view, 0));
    return length(cross(d, move)) / dot(d, d) * max(size.x / (2.0 * PI), size.y / PI);
}

vec4 panorama_texel(int face, int x, int y)
{
    ivec2 size = textureSize(view, 0);
    int column = wrap_index(x, size.x);
    if (y >= 0 && y < size.y)
        return fetch(column, y);
    int row = clamp(y, 0, size.y - 1);
    return 0.5 * (fetch(wrap_index(column + size.x / 2, size.x), row) +
                  fetch(wrap_index(column + (size.x + 1) / 2, size.x), row));
}
