// A cylinder. After panorama_layout.
bool panorama_pixel(out vec2 xy, out int face, vec3 d)
{
    face = 0;
    float h = d.y / length(d.xz);
    if (!(h >= elevation.x && h <= elevation.y))
        return false;
    float down = (elevation.y - h) / (elevation.y - elevation.x);
    xy = vec2(azimuth_column(d), down * float(textureSize(view, 0).y));
    return true;
}

float panorama_texels(vec3 d, vec3 move)
{
    float square = dot(d.xz, d.xz);
    float h = d.y / sqrt(square);
    float turn = (d.x * move.z - d.z * move.x) / square;
    float rise = move.y / sqrt(square) - h * dot(d.xz, move.xz) / square;
    return length(vec2(turn * float(textureSize(view, 0).x) / (2.0 * PI),
                       rise * float(textureSize(view, 0).y) / (elevation.y - elevation.x)));
}

vec4 panorama_texel(int face, int x, int y)
{
    ivec2 size = textureSize(view, 0);
    return fetch(wrap_index(x, size.x), clamp(y, 0, size.y - 1));
}
